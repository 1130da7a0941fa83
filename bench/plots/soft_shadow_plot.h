#pragma once

#include <filesystem>
#include <string>

#include "bench/plots/table.h"

namespace cairn::bench {

/// A gnuplot script that draws the table of chart_soft_shadow_map() to a PNG: a row of panels for each
/// occluder with the errors (Atty et al. 2005, figures 17 to 20), and one with times and formats (21 to 23).
[[nodiscard]] std::string soft_shadow_plot(const Table& table, const std::filesystem::path& picture);

}  // namespace cairn::bench
