#pragma once

#include <memory>
#include <optional>

#include "app/options/names.h"
#include "app/options/options.h"
#include "app/subject/scene_input.h"
#include "app/terminal/driver.h"
#include "app/terminal/report.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxel_attributes.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/solid/solid_tiles.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::app {

/// Options that `cairn voxelize` and `cairn check` have in common.
struct VoxelizationOptions {
    CommonOptions common;
    GridOptions grid;
    voxelizer::Method method = voxelizer::Method::conservative;
};
void add_voxelization_options(CLI::App& verb, VoxelizationOptions& options);

/// A scene, and the grid to voxelize it in.
struct GriddedInput {
    SceneInput input;
    voxelizer::Grid grid;
    double load_ms = 0.0;
};
/// @throws Error  if the scene cannot be loaded or the options are not those of a grid, before anything is
/// written.
[[nodiscard]] GriddedInput load_gridded(const VoxelizationOptions& options);

/// Voxelizes a scene on the GPU, tile by tile.
class Voxelization {
public:
    struct Needs {
        bool attributes = false;                         ///< tiles have colours and normals
        bool surface = false;                            ///< surface() is kept after the upload
        std::optional<voxelizer::SolidRule> solid = {};  ///< insides of closed parts are filled
        bool doubts = false;                             ///< doubtful voxels are wanted
    };
    /// Prepares everything on the GPU, and frees the scene.
    Voxelization(const VoxelizationOptions& options, GriddedInput scene, const Needs& needs);

    [[nodiscard]] const voxelizer::Grid& grid() const { return grid_; }
    [[nodiscard]] const voxelizer::Surface& surface() const { return *surface_; }

    /// Voxelizes all tiles, in order, and passes them to `sink`. Warns of voxels of a solid that are
    /// doubtful, and passes tiles of them to `doubtful`, if it is there.
    /// @throws Error  Fault::interrupted if Interrupt::asked(); Fault::memory if there is `doubtful`, but
    /// what
    ///                the outside reaches takes too much memory; what the sinks throw.
    void run(const voxelizer::TileSink& sink, const voxelizer::TileProgress& progress,
             const voxelizer::TileSink& doubtful = {});

    /// Adds the figures of both verbs: the grid, occupied voxels, times and the driver.
    void report(Report& report) const;

private:
    void add_attributes(voxelizer::VoxelTile& tile);
    void build_solid(bool needs_doubts);
    void check_doubts() const;
    void finish_solid(const voxelizer::TileSink& sink, const voxelizer::TileSink& doubtful);
    void warn_of_doubts() const;

    VoxelizationOptions options_;
    voxelizer::Grid grid_;
    double load_ms_ = 0.0;
    double surface_ms_ = 0.0;
    double context_ms_ = 0.0;
    double upload_ms_ = 0.0;
    std::optional<voxelizer::Surface> surface_;
    std::uint64_t triangle_count_ = 0;
    std::optional<voxelizer::SolidTiles> solid_;
    voxelizer::SolidRule rule_ = voxelizer::SolidRule::winding;
    double fill_ms_ = 0.0;
    std::optional<voxelizer::TriangleIndex> index_;
    std::optional<Driver> driver_;
    voxelizer::GpuSurface on_gpu_;
    std::unique_ptr<voxelizer::Voxelizer> voxelizer_;
    std::optional<voxelizer::AttributeVoxelizer> attributes_;
    double attributes_ms_ = 0.0;
    voxelizer::TileStatistics statistics_;
};

/// The names of what can be filled, as options and reports have them.
[[nodiscard]] const Names<std::optional<voxelizer::SolidRule>>& fill_names();

/// The value of "resolution" in a report: one number for a cube, else three.
[[nodiscard]] Json resolution_of(const voxelizer::Grid& grid);

}  // namespace cairn::app
