#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// How far towards a directional light there may be anything that casts a shadow, on a grid across the
/// light's direction.
struct ShadowEnds {
    /// A point p, in voxels of the finest level, lies in texel (dot(p, across) + across_offset, dot(p, down)
    /// + down_offset).
    glm::vec3 across{0.0F};
    float across_offset = 0.0F;
    glm::vec3 down{0.0F};
    float down_offset = 0.0F;
    /// SHADOW_ENDS_SIDE^2 texels, row after row: beyond dot(p, direction to the light) = end, nothing stands
    /// in the light.
    std::vector<float> ends;
};

/// The ends of shadow rays that start on what the view shows. Conservative, like block_starts(): no shadow
/// changes.
/// @param view        its light must be directional.
/// @param is_blended  rays see mips of bricks too.
[[nodiscard]] ShadowEnds shadow_ends(const interop::MarchView& view, const Tree& tree, bool is_blended);

}  // namespace cairn::renderer
