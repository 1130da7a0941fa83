#pragma once

#include <glm/glm.hpp>

#include "optics/light.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

/// The window of directions that a map covers, as tangents x / z and y / z of light space.
struct ShadowWindow {
    glm::dvec2 low{-1.0};
    glm::dvec2 high{1.0};
    bool operator==(const ShadowWindow&) const = default;
};

/// What the centre of a light sees of the occluders and of the receivers.
struct ShadowFrustum {
    /// Distance of the near plane from the light's plane, positive. Anything nearer is not seen.
    double near_distance = 0.01;
    ShadowWindow occluders;
    ShadowWindow receivers;
    bool operator==(const ShadowFrustum&) const = default;
};

/// The largest tangent from the light's axis that a window may reach: about 87 degrees.
inline constexpr double max_shadow_tangent = 20.0;

/// The tightest windows: the bounds of the occluders, and the part of the receivers' bounds that a penumbra
/// can reach. Neither needs to be similar to the light, as the one window of Atty et al. 2005 is, because all
/// formulas hold axis by axis.
///
/// @param light          must be a rectangle.
/// @param near_distance  0: a thousandth of the depth of the furthest vertex.
/// @throws Error  as optics::light_from_world does.
[[nodiscard]] ShadowFrustum fit_shadow_frustum(const optics::Light& light, const scenes::Snapshot& occluders,
                                               const scenes::Snapshot& receivers, double near_distance = 0.0);

}  // namespace cairn::renderer
