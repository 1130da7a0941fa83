#pragma once

#include <filesystem>

#include "voxelizer/bit_grid.h"

namespace cairn::voxelizer {

/// Writes voxels as NumPy's .npy, version 1: uint8, shape (size.x, size.y, size.z), C order, so a[x, y, z]; 1
/// = occupied. One slab of x is in memory at a time.
/// @throws Error as OutputFile does.
void write_npy(const BitGrid& bits, const std::filesystem::path& path);

}  // namespace cairn::voxelizer
