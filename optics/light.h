#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::optics {

/// What of a positional light there is around its middle.
enum class LightShape : std::uint8_t {
    sphere,     ///< of Light::radius, which may be 0: a point
    rectangle,  ///< middle +- half_u +- half_v; it shines to both sides
    disk,       ///< the ellipse with these half axes
};

/// One light, white by default. It shades as its middle does; its extent makes shadows soft, where a view
/// asks for more than one shadow ray.
struct Light {
    bool positional = false;
    glm::dvec3 position{0.0};            ///< of the middle, world, when positional
    glm::dvec3 towards{0.4, 0.8, 0.45};  ///< direction to the light, when not
    LightShape shape = LightShape::sphere;
    double radius = 0.0;     ///< of a sphere
    glm::dvec3 half_u{0.0};  ///< of a rectangle or a disk
    glm::dvec3 half_v{0.0};
    double angle = 0.0;  ///< of a directional light: radians from its middle to its edge, [0, pi / 2)
    glm::vec3 color{1.0F};
    float ambient = 0.25F;  ///< light from everywhere, as a share of the light's own
    bool operator==(const Light&) const = default;
};

/// Whether it has an extent, without which there are no soft shadows.
[[nodiscard]] inline bool has_extent(const Light& light) {
    if (!light.positional) return light.angle > 0.0;
    if (light.shape == LightShape::sphere) return light.radius > 0.0;
    return light.half_u != glm::dvec3(0.0) || light.half_v != glm::dvec3(0.0);
}

/// Unit, from a point of the world to its middle.
[[nodiscard]] inline glm::dvec3 direction_to(const Light& light, const glm::dvec3& point) {
    return glm::normalize(light.positional ? light.position - point : light.towards);
}

/// A rectangle at `position` that faces `target`: along cross(half_u, half_v), with two edges level where
/// `up` is vertical. All else is as in Light.
///
/// @param width   from edge to edge along half_u, world units; `height` along half_v.
/// @throws Error  Fault::usage when a size is not positive, or the target is the position.
[[nodiscard]] Light aimed_light(const glm::dvec3& position, const glm::dvec3& target, double width,
                                double height, const glm::dvec3& up = {0.0, 1.0, 0.0});

/// Light space of a rectangle: its middle is the origin, half_u lies along +x, half_v along +y, and what
/// cross(half_u, half_v) points to has a positive z. World units.
///
/// @throws Error  Fault::usage for a light that is no rectangle, or when a half axis has no length, or they
///                are not at a right angle.
[[nodiscard]] glm::dmat4 light_from_world(const Light& light);

/// Half the width and the height of a rectangle, world units.
///
/// @throws Error  Fault::usage for a light that is no rectangle.
[[nodiscard]] glm::dvec2 half_size(const Light& light);

}  // namespace cairn::optics
