#pragma once

#include <span>

#include "shaders/interop/surface.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Marks the triangles that pass the range of the shaders' arithmetic: the same row spans, in 128-bit
/// integers.
/// @param bits  of the region; marks are added.
void mark_far_triangles(std::span<const FarTriangle> triangles,
                        std::span<const interop::SurfaceMaterial> materials,
                        std::span<const std::uint32_t> texels, const Region& region, BitGrid& bits);

}  // namespace cairn::voxelizer
