#pragma once

#include <filesystem>
#include <memory>

#include "voxelizer/bit_grid.h"
#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Writes NumPy's .npy, version 1: uint8, shape = the grid's resolution, C order, so a[x, y, z]; 1 =
/// occupied. The file says nothing of the world, nor of attributes.
///
/// Long runs of empty voxels are holes in the file where the file system can have them. Memory: VoxelRows'.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_npy_writer(const std::filesystem::path& path,
                                                           const Grid& grid);

/// The same from a whole.
/// @throws Error as OutputFile does.
void write_npy(const BitGrid& bits, const std::filesystem::path& path);

}  // namespace cairn::voxelizer
