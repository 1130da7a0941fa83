#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::optics {

/// The shape of a positional light around its middle.
enum class LightShape : std::uint8_t {
    sphere,     ///< a sphere of Light::radius; a point if that is 0
    rectangle,  ///< middle +- half_u +- half_v; shines to both sides
    disk,       ///< the ellipse with half axes half_u and half_v
};

/// One light, white by default. Surfaces are shaded as if all light came from its middle; its extent makes
/// shadows soft if a view asks for more than one shadow ray.
struct Light {
    bool positional = false;
    /// Middle of a positional light, world.
    glm::dvec3 position{0.0};
    /// Direction to a directional light, world; any length but 0.
    glm::dvec3 towards{0.4, 0.8, 0.45};
    LightShape shape = LightShape::sphere;
    double radius = 0.0;     ///< radius of a sphere, world units
    glm::dvec3 half_u{0.0};  ///< half axis of a rectangle or disk, world
    glm::dvec3 half_v{0.0};  ///< the other half axis
    /// Angle from the middle of a directional light to its edge: radians, [0, pi / 2).
    double angle = 0.0;
    glm::vec3 color{1.0F};
    /// Light from everywhere, as a share of `color`.
    float ambient = 0.25F;
    bool operator==(const Light&) const = default;
};

/// Whether a light has an extent. A light without one throws no soft shadows.
[[nodiscard]] inline bool has_extent(const Light& light) {
    if (!light.positional) return light.angle > 0.0;
    if (light.shape == LightShape::sphere) return light.radius > 0.0;
    return light.half_u != glm::dvec3(0.0) || light.half_v != glm::dvec3(0.0);
}

/// Unit vector from a point of the world to the light's middle.
[[nodiscard]] inline glm::dvec3 direction_to(const Light& light, const glm::dvec3& point) {
    return glm::normalize(light.positional ? light.position - point : light.towards);
}

/// @throws Error  Fault::usage if the light shines from nowhere: a radius or an angle is out of range, a
///                coordinate is not finite or past `farthest_place`, or it has no direction.
void check_light(const Light& light);

/// A rectangle at `position` that faces `target`: cross(half_u, half_v) points there. Two edges are level if
/// `up` is vertical. All other fields are as in Light.
///
/// @param width   length from edge to edge along half_u, world units; `height`: along half_v.
/// @throws Error  Fault::usage if a size is not positive, or the target is the position.
[[nodiscard]] Light aimed_light(const glm::dvec3& position, const glm::dvec3& target, double width,
                                double height, const glm::dvec3& up = {0.0, 1.0, 0.0});

/// Transforms the world to the light space of a rectangle: the rectangle's middle is the origin, half_u lies
/// along +x, half_v along +y, and points on the side that cross(half_u, half_v) points to have a positive z.
/// Lengths stay world units.
///
/// @throws Error  Fault::usage if the light is not a rectangle, a half axis has no length, or the half axes
///                are not at a right angle.
[[nodiscard]] glm::dmat4 light_from_world(const Light& light);

/// Half the width and half the height of a rectangle, world units.
///
/// @throws Error  Fault::usage if the light is not a rectangle.
[[nodiscard]] glm::dvec2 half_size(const Light& light);

}  // namespace cairn::optics
