#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

/// All nodes of a scene at one moment.
struct Pose {
    std::vector<glm::dmat4> world_from_node;  ///< one a node
    std::vector<std::vector<float>>
        morph_weights;  ///< one a node that an animation morphs; empty: the node's own
};

[[nodiscard]] glm::dmat4 matrix_of(const Trs& trs);

/// Evaluates an animation (null: none) and multiplies down the node hierarchy, in double.
/// Interpolation: glTF 2.0, appendix C.
[[nodiscard]] Pose take_pose(const Scene& scene, const Animation* animation, double seconds);

/// The value of a channel, `width` numbers; rotations have length 1. Times outside the keys are clamped to
/// them.
[[nodiscard]] std::vector<double> evaluate(const Channel& channel, double seconds);

}  // namespace cairn::scenes
