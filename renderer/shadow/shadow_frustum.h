#pragma once

#include <glm/glm.hpp>

#include "optics/light.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

/// What a map covers, as tangents x / z and y / z of light space.
struct ShadowWindow {
    glm::dvec2 low{-1.0};
    glm::dvec2 high{1.0};
    bool operator==(const ShadowWindow&) const = default;
};

/// What the centre of a light sees of the occluders and of the receivers.
struct ShadowFrustum {
    double near_distance = 0.01;  ///< from the light's plane, positive; what is nearer is not seen
    ShadowWindow occluders;
    ShadowWindow receivers;
    bool operator==(const ShadowFrustum&) const = default;
};

/// Windows may reach this far from the light's axis: about 87 degrees.
inline constexpr double max_shadow_tangent = 20.0;

/// The tightest windows: the occluders' bounds, and of the receivers' bounds what a penumbra can reach. The
/// two need not be similar to the light, as the one window of Atty et al. is: all formulas hold axis by axis.
///
/// @param light          a rectangle.
/// @param near_distance  0: a thousandth of the furthest vertex's depth.
/// @throws Error  as optics::light_from_world does.
[[nodiscard]] ShadowFrustum fit_shadow_frustum(const optics::Light& light, const scenes::Snapshot& occluders,
                                               const scenes::Snapshot& receivers, double near_distance = 0.0);

}  // namespace cairn::renderer
