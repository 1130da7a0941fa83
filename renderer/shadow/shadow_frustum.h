#pragma once

#include <glm/glm.hpp>

#include "scenes/snapshot.h"

namespace cairn::renderer {

/// A flat rectangle that shines to one side, that of cross(half_u, half_v). World units.
struct RectangleLight {
    glm::dvec3 centre{0.0, 1.0, 0.0};
    glm::dvec3 half_u{0.1, 0.0, 0.0};  ///< from the centre to the middle of an edge
    glm::dvec3 half_v{0.0, 0.0, 0.1};  ///< the same for the next edge: at a right angle to half_u
    bool operator==(const RectangleLight&) const = default;
};

/// A light at `centre` that shines on `target`, with two edges level where `up` is vertical.
/// @throws Error  Fault::usage when a size is not positive, or the target is the centre.
[[nodiscard]] RectangleLight aimed_light(const glm::dvec3& centre, const glm::dvec3& target, double width,
                                         double height, const glm::dvec3& up = {0.0, 1.0, 0.0});

/// Light space: the light's centre is the origin, half_u lies along +x, half_v along +y, and it shines along
/// +z. World units.
/// @throws Error  Fault::usage when a half axis has no length, or they are not at a right angle.
[[nodiscard]] glm::dmat4 light_from_world(const RectangleLight& light);

/// Half the light's width and height.
[[nodiscard]] glm::dvec2 half_size(const RectangleLight& light);

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
/// @param near_distance  0: a thousandth of the furthest vertex's depth.
/// @throws Error  as light_from_world does.
[[nodiscard]] ShadowFrustum fit_shadow_frustum(const RectangleLight& light, const scenes::Snapshot& occluders,
                                               const scenes::Snapshot& receivers, double near_distance = 0.0);

}  // namespace cairn::renderer
