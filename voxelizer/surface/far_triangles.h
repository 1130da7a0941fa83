#pragma once

#include <span>

#include "shaders/interop/surface.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Marks far triangles, which pass the range of the shaders' arithmetic, by the same row spans in 128-bit
/// integers.
/// @param bits  bits of the region, to which marks are added.
void mark_far_triangles(std::span<const FarTriangle> triangles,
                        std::span<const interop::SurfaceMaterial> materials,
                        std::span<const std::uint32_t> texels, const Region& region, BitGrid& bits);

}  // namespace cairn::voxelizer
