#pragma once

#include <filesystem>
#include <string>

#include "bench/plots/table.h"

namespace cairn::bench {

/// The gnuplot script of chart_shadow's picture. For each scene four panels, time against error: for a hard
/// light the share of pixels on the wrong side, for a soft light the RMSE; on the ground and on all
/// receivers. One line per method and parameter that is varied; exact results lie on the frame's bottom.
/// Points that no other beats in both are ringed and labelled with their setting.
[[nodiscard]] std::string shadow_plot(const Table& table, const std::filesystem::path& picture);

}  // namespace cairn::bench
