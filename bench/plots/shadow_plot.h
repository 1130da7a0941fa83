#pragma once

#include <filesystem>
#include <string>

#include "bench/plots/table.h"

namespace cairn::bench {

/// The gnuplot script of chart_shadow's picture. For each scene four panels, time against error: of a hard
/// light the share of pixels on the wrong side, of a soft one the RMSE; on the ground and on all. One line a
/// method and what is varied of it; exact results lie on the frame's bottom. What no other beats in both is
/// ringed and has its setting beside it.
[[nodiscard]] std::string shadow_plot(const Table& table, const std::filesystem::path& picture);

}  // namespace cairn::bench
