#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

struct DeformedVertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< of length 1 or 0; empty when the primitive has none
};

/// Adds the morph targets' displacements, each times its weight. Weights that are not finite count as 0.
[[nodiscard]] DeformedVertices morph(const Primitive& primitive, std::span<const float> weights);

/// Moves vertices by the weighted sum of their joints' matrices (glTF 2.0, 3.7.3.3); results are in world
/// space. A vertex without weights follows its first joint.
/// @param world_from_mesh  one a joint: world_from_joint * joint_from_mesh.
void skin(const Primitive& primitive, std::span<const glm::dmat4> world_from_mesh,
          DeformedVertices& vertices);

}  // namespace cairn::scenes
