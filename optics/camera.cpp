#include "optics/camera.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "base/error.h"

namespace cairn::optics {

void check_camera(const Camera& camera) {
    const auto fail = [](const std::string& what, const std::string& way_out) {
        throw Error(Fault::usage, "view", what, way_out);
    };
    if (!(camera.yfov > 0.0 && camera.yfov < 3.14159)) {
        fail(fmt::format("a field of view of {} degrees", glm::degrees(camera.yfov)),
             "choose more than 0 and less than 180 degrees; 45 suit most scenes");
    }
    for (const glm::dvec3& place : {camera.eye, camera.target}) {
        const glm::dvec3 reach = glm::abs(place);
        if (!std::isfinite(glm::length(place)))
            fail("the camera's eye or its target is not finite", "use finite coordinates");
        if (std::max({reach.x, reach.y, reach.z}) > farthest_place)
            fail(fmt::format("the camera's eye or its target is at {}, {}, {}", place.x, place.y, place.z),
                 fmt::format("use coordinates up to {}", farthest_place));
    }
    const glm::dvec3 forward = camera.target - camera.eye;
    const double length = glm::length(forward);
    if (length == 0.0) fail("the camera looks at where it stands", "move its target away from its eye");
    const double side = glm::length(glm::cross(forward / length, camera.up));
    if (!std::isfinite(side) || side < 1e-9)
        fail("the camera's up direction is the one it looks along", "choose another up direction");
}

Camera framing_camera(const scenes::Bounds& bounds, double aspect) {
    Camera camera;
    if (bounds.empty()) return camera;
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const glm::dvec3 half = 0.5 * (bounds.high - bounds.low);
    const glm::dvec3 back = glm::normalize(glm::dvec3(0.55, 0.45, 1.0));
    const glm::dvec3 right = glm::normalize(glm::cross(camera.up, back));
    const glm::dvec3 up = glm::cross(back, right);
    const double tan_y = std::tan(0.5 * camera.yfov);
    const double tan_x = tan_y * aspect;
    double distance = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner = half * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const double beside =
            std::max(std::abs(glm::dot(corner, right)) / tan_x, std::abs(glm::dot(corner, up)) / tan_y);
        distance = std::max(distance, beside + glm::dot(corner, back));
    }
    constexpr double margin = 1.06;
    const double least = std::max(1e-12, 1e-12 * glm::length(centre));  // a scene of one point
    camera.target = centre;
    camera.eye = centre + back * std::max(distance * margin, least);
    return camera;
}

Camera extrapolated(const Camera& before, const Camera& now) {
    Camera next = now;
    next.eye += now.eye - before.eye;
    next.target += now.target - before.target;
    const glm::dvec3 forward = next.target - next.eye;
    // A camera that would look at where it stands, or along its up direction, is none.
    const double least = 1e-6 * glm::length(forward) * glm::length(next.up);
    return glm::length(glm::cross(forward, next.up)) > least ? next : now;
}

}  // namespace cairn::optics
