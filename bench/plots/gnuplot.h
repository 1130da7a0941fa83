#pragma once

#include <filesystem>
#include <string>

namespace cairn::bench {

/// Runs gnuplot on a script in a folder, into which its pictures go. Waits for its end.
/// @return the reason of a failure, in words; empty if there was none.
[[nodiscard]] std::string run_gnuplot(const std::string& script, const std::filesystem::path& folder);

}  // namespace cairn::bench
