#pragma once

#include <filesystem>
#include <string>

#include "bench/plots/table.h"

namespace cairn::bench {

/// The gnuplot script of chart_render's picture: for each scene two panels, time against the error of
/// colours and of the silhouette. One line per tree shape, through its pixel errors; traversals and pools are
/// points of their own. Points that no other beats in both are ringed.
[[nodiscard]] std::string render_plot(const Table& table, const std::filesystem::path& picture);

}  // namespace cairn::bench
