#include "optics/light.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "base/error.h"
#include "optics/camera.h"

namespace cairn::optics {
namespace {

void check_rectangle(const Light& light) {
    if (light.positional && light.shape == LightShape::rectangle) return;
    throw Error(Fault::usage, "light", "it is no rectangle", "choose a rectangle with a place");
}

}  // namespace

void check_light(const Light& light) {
    const auto fail = [](const std::string& what, const std::string& way_out) {
        throw Error(Fault::usage, "view", what, way_out);
    };
    if (!(light.radius >= 0.0 && light.radius <= farthest_place))
        fail(fmt::format("a light with a radius of {}", light.radius), "choose 0, a point, or more");
    if (!(light.angle >= 0.0 && light.angle < 1.5707)) {
        fail(fmt::format("a light with an angle of {} degrees", glm::degrees(light.angle)),
             "choose at least 0 and less than 90 degrees; the sun's is 0.27");
    }
    const auto is_near = [](const glm::dvec3& place) {
        const glm::dvec3 reach = glm::abs(place);  // comparisons are false for what is not a number
        return reach.x <= farthest_place && reach.y <= farthest_place && reach.z <= farthest_place;
    };
    if (!is_near(light.half_u) || !is_near(light.half_v))
        fail("the light's half axes are not finite, or endless", "use finite ones");
    const glm::dvec3 place = light.positional ? light.position : light.towards;
    if (!std::isfinite(glm::length(place)) || (!light.positional && glm::length(place) == 0.0))
        fail("the light has no direction", "give it a finite one that is not zero");
    if (light.positional && !is_near(place))
        fail(fmt::format("the light is at {}, {}, {}", place.x, place.y, place.z),
             fmt::format("use coordinates up to {}, or a direction", farthest_place));
}

Light aimed_light(const glm::dvec3& position, const glm::dvec3& target, double width, double height,
                  const glm::dvec3& up) {
    const glm::dvec3 way = target - position;
    if (!(width > 0.0) || !(height > 0.0) || !(glm::length(way) > 0.0)) {
        throw Error(Fault::usage, "light", "a rectangle needs a width, a height and a target to shine on");
    }
    const glm::dvec3 forward = glm::normalize(way);
    glm::dvec3 across = glm::cross(up, forward);
    if (glm::length(across) < 1e-6 * glm::length(up))  // straight up or down: any direction is level
        across = std::abs(forward.x) < 0.5 ? glm::cross(glm::dvec3(1, 0, 0), forward)
                                           : glm::cross(glm::dvec3(0, 0, 1), forward);
    across = glm::normalize(across);
    Light light;
    light.positional = true;
    light.position = position;
    light.shape = LightShape::rectangle;
    light.half_u = 0.5 * width * across;
    light.half_v = 0.5 * height * glm::cross(forward, across);
    return light;
}

glm::dmat4 light_from_world(const Light& light) {
    const glm::dvec2 half = half_size(light);
    if (!(half.x > 0.0) || !(half.y > 0.0) || !std::isfinite(half.x + half.y)) {
        throw Error(Fault::usage, "light", "a half axis of the rectangle has no length",
                    "give a small rectangle instead of a point or a line");
    }
    const glm::dvec3 u = light.half_u / half.x;
    const glm::dvec3 v = light.half_v / half.y;
    if (std::abs(glm::dot(u, v)) > 1e-6) {
        throw Error(Fault::usage, "light", "the half axes of the rectangle are not at a right angle");
    }
    const glm::dmat3 axes = glm::transpose(glm::dmat3(u, v, glm::cross(u, v)));
    glm::dmat4 matrix(axes);
    matrix[3] = glm::dvec4(-(axes * light.position), 1.0);
    return matrix;
}

glm::dvec2 half_size(const Light& light) {
    check_rectangle(light);
    return {glm::length(light.half_u), glm::length(light.half_v)};
}

}  // namespace cairn::optics
