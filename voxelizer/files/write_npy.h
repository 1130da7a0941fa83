#pragma once

#include <filesystem>
#include <memory>

#include "voxelizer/bit_grid.h"
#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Writes NumPy's .npy, version 1: uint8, shape = the grid's resolution, C order, so a[x, y, z]; 1 =
/// occupied. The file holds neither the grid's place in the world nor attributes.
///
/// Long runs of empty voxels are holes in the file, if the file system supports holes. Memory: as VoxelRows.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_npy_writer(const std::filesystem::path& path,
                                                           const Grid& grid);

/// Writes a whole grid as .npy.
/// @throws Error as OutputFile does.
void write_npy(const BitGrid& bits, const std::filesystem::path& path);

}  // namespace cairn::voxelizer
