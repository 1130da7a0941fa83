#pragma once

#include <cstdint>

#include "scenes/scene.h"

/// Animated scenes made here, with animation 0 from 0 to 2 seconds.
namespace cairn::test {

/// All that can move, at once: a mirrored and unevenly scaled root; a mesh with morph targets (one without
/// positions, one without normals, one that is never weighed) whose weights follow a spline; a skin with
/// eight influences, weights that do not sum to 1 and a vertex without any; a mesh with both; a mesh in
/// instances; segments and points; a node flattened to a plane.
[[nodiscard]] scenes::Scene moving_zoo(std::uint32_t seed);

/// A triangle whose node slides along x: at 0 s by 0, at 2 s by `distance`.
[[nodiscard]] scenes::Scene sliding_triangle(float distance);

/// A point for each position, on a node that does not move.
[[nodiscard]] scenes::Scene points_at(std::vector<glm::vec3> positions);

}  // namespace cairn::test
