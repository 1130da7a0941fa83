#pragma once

#include <span>

#include "voxelizer/grid.h"
#include "voxelizer/surface.h"

namespace cairn::voxelizer {

/// The parts of far triangles near a region, as triangles in the shaders' range, with their texture
/// coordinates, vertex colours and materials, and no vertex normals. Their corners are rounded to the
/// lattice: good for attributes, not for bits.
[[nodiscard]] GpuSurfaceChunk upload_far_pieces(std::span<const FarTriangle> triangles, const Region& region);

}  // namespace cairn::voxelizer
