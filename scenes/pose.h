#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

namespace cairn::scenes {

/// All nodes of a scene at one moment.
struct Pose {
    std::vector<glm::dmat4> world_from_node;  ///< one matrix per node
    /// Per node, the morph weights that the animation gives its mesh; empty if it gives none: then the node's
    /// weights count.
    std::vector<std::vector<float>> morph_weights;
};

[[nodiscard]] glm::dmat4 matrix_of(const Trs& trs);

/// Evaluates one animation at many moments. Only the first evaluation allocates memory.
class Poser {
public:
    /// @param animation  null: the rest pose. Scene and animation must outlive the poser.
    Poser(const Scene& scene, const Animation* animation);

    /// Evaluates the animation and multiplies down the node hierarchy, in double; valid until the next call.
    /// Interpolation: glTF 2.0, appendix C.
    const Pose& at(double seconds);

private:
    void apply(const Channel& channel, double seconds);

    const Scene& scene_;
    const Animation* animation_;
    std::vector<std::size_t> order_;  ///< numbers of all nodes, parents before children
    std::vector<int> parents_;        ///< per node the number of its parent; -1: no parent
    std::vector<Trs> moved_;
    std::vector<double> value_;
    std::vector<double> next_;
    Pose pose_;
};

/// The transform of a node's mesh: at the node's instance `instance`, or at the node itself if that is -1.
[[nodiscard]] glm::dmat4 world_from_instance(const Node& node, const glm::dmat4& world_from_node,
                                             int instance);

/// The transform to the world from the mesh space of a skin, by one of its joints.
[[nodiscard]] glm::dmat4 world_by_joint(const Skin& skin, const Pose& pose, std::size_t joint);

/// The morph weights of a node's mesh in a pose: the animation's, else the node's, else the mesh's.
[[nodiscard]] std::span<const float> morph_weights_of(const Scene& scene, const Pose& pose, std::size_t node);

/// The pose at one moment.
[[nodiscard]] Pose take_pose(const Scene& scene, const Animation* animation, double seconds);

/// The value of a channel, `width` numbers; rotations have length 1. Times outside the keys are clamped to
/// them.
[[nodiscard]] std::vector<double> evaluate(const Channel& channel, double seconds);

}  // namespace cairn::scenes
