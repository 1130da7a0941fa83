#pragma once

#include <string>
#include <string_view>

namespace cairn::app {

/// Replaces names of a library in one of its texts by options of the command:
/// "choose another ContextOptions::kind" becomes "choose another --context".
[[nodiscard]] std::string with_option_names(std::string_view text);

}  // namespace cairn::app
