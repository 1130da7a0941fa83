#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

struct DeformedVertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< length 1 or 0; empty if the primitive has no normals
};

// The order of all operations here is part of the contract, because shaders/voxelize/deform.comp.glsl follows
// it to the same bits: float for morph targets, which move vertices in the space of their mesh; double for
// skins, which place them in the world, where floats would be coarser than voxels.

/// Adds the morph targets' displacements, each times its weight, target by target. Weights that are not
/// finite count as 0.
[[nodiscard]] DeformedVertices morph(const Primitive& primitive, std::span<const float> weights);

/// Places vertices by the weighted sum of their joints' matrices (glTF 2.0, 3.7.3.3). A vertex whose weights
/// are all 0 follows the skin's first joint.
/// @param world_from_mesh  one matrix per joint, at least one: world_from_joint * joint_from_mesh.
/// @param vertices         in the mesh's space; their normals are turned to the world.
/// @return                 positions in the world, one per vertex.
[[nodiscard]] std::vector<glm::dvec3> skin(const Primitive& primitive,
                                           std::span<const glm::dmat4> world_from_mesh,
                                           DeformedVertices& vertices);

}  // namespace cairn::scenes
