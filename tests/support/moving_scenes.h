#pragma once

#include <cstdint>

#include "scenes/scene.h"

/// Animated scenes for tests. Animation 0 lasts from 0 to 2 seconds.
namespace cairn::test {

/// Everything that can move in one scene: a mirrored and unevenly scaled root; a mesh with morph targets (one
/// without positions, one without normals, one that is never weighed) whose weights follow a spline; a skin
/// with eight influences, weights that do not sum to 1 and a vertex without any; a mesh with both; a mesh in
/// instances; segments and points; a node flattened to a plane.
[[nodiscard]] scenes::Scene moving_zoo(std::uint32_t seed);

/// A triangle whose node slides along x: by 0 at 0 s, by `distance` at 2 s.
[[nodiscard]] scenes::Scene sliding_triangle(float distance);

/// A point per position, on a node that does not move.
[[nodiscard]] scenes::Scene points_at(std::vector<glm::vec3> positions);

}  // namespace cairn::test
