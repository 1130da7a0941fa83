#pragma once

#include <string>
#include <string_view>

namespace cairn::app {

/// The text of a library with the options of the command in the place of the library's own names:
/// "choose another ContextOptions::kind" becomes "choose another --context". Libraries know no command line.
[[nodiscard]] std::string with_option_names(std::string_view text);

}  // namespace cairn::app
