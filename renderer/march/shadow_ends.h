#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// How far towards a directional light there may be anything, on a grid across its direction.
struct ShadowEnds {
    /// A place p, in voxels of the finest level, lies in texel (dot(p, across) + across_offset, dot(p, down)
    /// + down_offset).
    glm::vec3 across{0.0F};
    float across_offset = 0.0F;
    glm::vec3 down{0.0F};
    float down_offset = 0.0F;
    /// SHADOW_ENDS_SIDE^2, row after row: behind dot(p, direction to the light) = end nothing stands in the
    /// light.
    std::vector<float> ends;
};

/// For rays from what the view shows to its light. Conservative, like block_starts(): no shadow changes.
/// @param view        its light is directional.
/// @param is_blended  rays see mips too.
[[nodiscard]] ShadowEnds shadow_ends(const interop::MarchView& view, const Tree& tree, bool is_blended);

}  // namespace cairn::renderer
