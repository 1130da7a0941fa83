#pragma once

#include <filesystem>
#include <string>

namespace cairn::bench {

/// Runs gnuplot on a script in a folder, where its pictures then are. Waits for its end.
/// @return what stood in the way, in words; empty when all went well.
[[nodiscard]] std::string run_gnuplot(const std::string& script, const std::filesystem::path& folder);

}  // namespace cairn::bench
