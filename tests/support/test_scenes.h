#pragma once

#include "scenes/scene.h"

/// Small scenes whose pictures can be predicted by hand, with flat normals and without textures.
namespace cairn::test {

/// A ball of 320 triangles, a little above a floor of two; tilted so that nothing lies on voxel planes.
[[nodiscard]] scenes::Scene ball_over_floor();

/// The square |x|, |z| <= 0.5 at y = 1 over the floor |x|, |z| <= 2 at y = 0.
[[nodiscard]] scenes::Scene square_over_floor();

/// The square |x|, |z| <= 1 at y = 0 in one linear colour.
[[nodiscard]] scenes::Scene sheet(const glm::vec4& color);

/// A scene of one triangle mesh, not indexed, in one white material.
[[nodiscard]] scenes::Scene triangles(std::vector<glm::vec3> corners);

}  // namespace cairn::test
