#pragma once

#include <filesystem>
#include <memory>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Writes Patrick Min's .binvox, version 1 (patrickmin.com/binvox/binvox.html): run-length coded, y runs
/// fastest, then z, then x. The centre of voxel (i, j, k) lies at translate + scale * (i + 0.5, j + 0.5, k +
/// 0.5) / dim.
///
/// The format asks for a cube and has one scale. A grid that is not a cube is filled up with empty voxels
/// past its high ends, so that every reader finds each voxel in its place; empty space costs a byte per 127
/// voxels. Memory: as VoxelRows.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_binvox_writer(const std::filesystem::path& path,
                                                              const Grid& grid);

}  // namespace cairn::voxelizer
