#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "bench/trials/chart.h"

namespace cairn::bench {

/// A chart by its name, "voxelize" for instance.
struct ChartKind {
    std::string_view name;
    std::string_view description;
    Chart (*draw)(const ChartOptions& options);
    /// Options of voxels that the chart takes. The others it varies itself, or has no use for.
    VoxelOptionsTaken takes = {};
};
[[nodiscard]] std::span<const ChartKind> charts();

/// Every voxelization method and its peers, by time and by error against the exact voxels: voxelize.csv and
/// voxelize.png. Like all charts, it needs a current context, and throws as loading, voxelizing, rendering
/// and writing do.
[[nodiscard]] Chart chart_voxelize(const ChartOptions& options);

/// Converged frames with hard shadows beside Embree's and NanoVDB's rays: embree.csv.
[[nodiscard]] Chart chart_embree(const ChartOptions& options);

/// Converged frames by time and by error against Embree with 64 samples per pixel: render.csv and render.png.
[[nodiscard]] Chart chart_render(const ChartOptions& options);

/// One view at rising resolutions: resolution.csv.
[[nodiscard]] Chart chart_resolution(const ChartOptions& options);

/// Crassin 2007, Figures 3.24 and 3.26: structure.csv.
[[nodiscard]] Chart chart_structure(const ChartOptions& options);

/// Crassin et al. 2008, Figure 7: exploration.csv.
[[nodiscard]] Chart chart_exploration(const ChartOptions& options);

/// The bricks that first frames produce, and how many of them are used: production.csv.
[[nodiscard]] Chart chart_production(const ChartOptions& options);

/// Animated scenes with soft shadows through pyramids built for each frame: moving_shadow.csv.
[[nodiscard]] Chart chart_moving_shadow(const ChartOptions& options);

/// Atty et al. 2005, sections 4.2 and 5.2: soft_shadow_map.csv and soft_shadow_map.png.
[[nodiscard]] Chart chart_soft_shadow_map(const ChartOptions& options);

/// The bricks that rays, occlusion queries (Crassin 2007, section 3.6) and the frustum alone produce for the
/// same views: visibility.csv.
[[nodiscard]] Chart chart_visibility(const ChartOptions& options);

/// Shadows of a hard and of a soft light by every method, by time and by error against Embree: shadow.csv and
/// shadow.png.
[[nodiscard]] Chart chart_shadow(const ChartOptions& options);

/// Forest et al. 2009, Tables 2 and 3: shadow_rays.csv.
[[nodiscard]] Chart chart_shadow_rays(const ChartOptions& options);

/// The conservative method against the exact reference, bit by bit: check.csv. Chart::differs is true if a
/// scene differs or fails.
[[nodiscard]] Chart chart_check(const ChartOptions& options);

/// Levels of detail by time, memory and error against Embree: levels.csv.
[[nodiscard]] Chart chart_levels(const ChartOptions& options);

/// Animations moved and voxelized for each frame, beside Embree's rebuilding: moving.csv.
/// @throws Error (Fault::usage) if a scene has no animation.
[[nodiscard]] Chart chart_moving(const ChartOptions& options);

/// One region that holds about 2000 triangles, with and without the index: region_deep.csv.
[[nodiscard]] Chart chart_region_deep(const ChartOptions& options);

/// A grid voxelized tile by tile, in regions of 1 to 64 MiB: region_sizes.csv.
[[nodiscard]] Chart chart_region_sizes(const ChartOptions& options);

/// Names the chart's table `name`, writes it as `folder`/`name`.csv, and adds the file to the chart's files.
/// @throws Error (Fault::usage) if the folder cannot be made or written to.
void write_table(Chart& chart, const std::filesystem::path& folder, const std::string& name);

/// Draws the chart's table as `folder`/NAME.png, NAME being the table's name. If that fails, adds a note with
/// the reason.
/// @param script_of  makes the gnuplot script that draws the table to a path
void write_picture(Chart& chart, const std::filesystem::path& folder,
                   std::string (*script_of)(const Table&, const std::filesystem::path&));

}  // namespace cairn::bench
