#pragma once

#include <filesystem>
#include <string>

#include "bench/plots/table.h"

namespace cairn::bench {

/// The gnuplot script of the chart: a panel for each scene, time against error, both logarithmic, with a lane
/// below the errors for exact methods and a lane above for methods that find no voxels. One line per method,
/// through its resolutions. Points on the Pareto front of their resolution (no other is both faster and
/// closer to the truth) are ringed.
///
/// @param table    the table of chart_voxelize
/// @param picture  the PNG to write
[[nodiscard]] std::string voxelize_plot(const Table& table, const std::filesystem::path& picture);

}  // namespace cairn::bench
