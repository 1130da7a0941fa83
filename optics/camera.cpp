#include "optics/camera.h"

#include <algorithm>
#include <cmath>

namespace cairn::optics {

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
