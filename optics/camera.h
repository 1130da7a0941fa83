#pragma once

#include <glm/glm.hpp>

#include "scenes/snapshot.h"

namespace cairn::optics {

/// A pinhole camera. Pixel (0, 0) is at the top left.
struct Camera {
    glm::dvec3 eye{0.0, 0.0, 1.0};
    glm::dvec3 target{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    double yfov = 0.785398163397448;  ///< whole vertical angle, radians, in (0, pi)
    bool operator==(const Camera&) const = default;
};

/// A camera that sees the whole of the bounds, from the front, above and the right.
/// @param aspect  width of the picture over its height.
[[nodiscard]] Camera framing_camera(const scenes::Bounds& bounds, double aspect);

/// The next position of a camera that moved from `before` to `now`, if it makes the same move again.
[[nodiscard]] Camera extrapolated(const Camera& before, const Camera& now);

}  // namespace cairn::optics
