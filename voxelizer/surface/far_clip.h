#pragma once

#include <span>

#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// The parts of far triangles within the range of shaders, [-2^24, 2^25] along each axis, as fans of
/// triangles, with their texture coordinates, vertex colours and materials, and no vertex normals. New
/// corners are rounded to the lattice: good enough for attributes and for drawing. Exact methods
/// use mark_far_triangles() instead.
///
/// Clipping: Sutherland and Hodgman 1974.
[[nodiscard]] SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles);

/// The parts of far triangles near a region: in the region and one voxel around it.
[[nodiscard]] SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles, const Region& region);

}  // namespace cairn::voxelizer
