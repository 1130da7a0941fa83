#pragma once

#include <span>

#include "voxelizer/surface.h"

namespace cairn::voxelizer {

/// The parts of far triangles within the range of shaders, [-2^24, 2^25] along each axis, as fans of
/// triangles. New corners are rounded to the lattice, which exact methods cannot use: they have
/// mark_far_triangles().
///
/// Clipping: Sutherland and Hodgman 1974.
[[nodiscard]] SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles);

}  // namespace cairn::voxelizer
