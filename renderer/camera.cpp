#include <algorithm>
#include <cmath>

#include "renderer/renderer.h"

namespace cairn::renderer {

Camera framing_camera(const scenes::Bounds& bounds, double aspect) {
    Camera camera;
    if (bounds.empty()) return camera;
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const double radius = std::max(0.5 * glm::length(bounds.high - bounds.low), 1e-12);
    // The bounding sphere fits the narrower of the two angles.
    const double half_angle = std::atan(std::tan(0.5 * camera.yfov) * std::min(aspect, 1.0));
    camera.target = centre;
    camera.eye = centre + glm::normalize(glm::dvec3(0.55, 0.45, 1.0)) * (radius / std::sin(half_angle));
    return camera;
}

}  // namespace cairn::renderer
