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

/// The largest coordinate of a camera or a light. Beyond it, floats of rays and of their squares overflow.
inline constexpr double farthest_place = 1e15;

/// @throws Error  Fault::usage if the camera shows nothing: its field of view is out of range, a coordinate
/// is
///                not finite or past `farthest_place`, it looks at where it stands or along its up direction.
void check_camera(const Camera& camera);

/// A camera that sees the whole of the bounds, from the front, above and the right.
/// @param aspect  width of the picture over its height.
[[nodiscard]] Camera framing_camera(const scenes::Bounds& bounds, double aspect);

/// The next position of a camera that moved from `before` to `now`, if it makes the same move again.
[[nodiscard]] Camera extrapolated(const Camera& before, const Camera& now);

}  // namespace cairn::optics
