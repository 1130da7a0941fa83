#pragma once

#include <string>

#include "app/options.h"
#include "app/report.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface.h"
#include "voxelizer/voxelizer.h"

namespace cairn::app {

/// What `cairn voxelize` and `cairn check` have in common.
struct VoxelizationOptions {
    CommonOptions common;
    GridOptions grid;
    voxelizer::Method method = voxelizer::Method::conservative;
};
void add_voxelization_options(CLI::App& verb, VoxelizationOptions& options);

/// A scene's voxels by the GPU, and the surface that they were made of.
struct Voxelization {
    voxelizer::Surface surface;
    voxelizer::Region region;
    voxelizer::BitGrid voxels;
};

/// Loads and voxelizes, and adds to the report what both verbs say: the grid, what is occupied, times and
/// driver. The scene and the driver are released on return.
[[nodiscard]] Voxelization voxelize_input(const VoxelizationOptions& options, Report& report);

}  // namespace cairn::app
