#pragma once

#include <glm/glm.hpp>

#include "renderer/renderer.h"

namespace cairn::app {

/// A camera that turns about its target. Until it is moved, it is the camera that it was made from.
class OrbitCamera {
public:
    /// @param scene_size  diagonal of the scene in world units, > 0. It bounds the distance to the target.
    OrbitCamera(const optics::Camera& camera, double scene_size);

    [[nodiscard]] const optics::Camera& camera() const { return camera_; }

    /// Turns the scene as if it were grabbed: x to the right, y downwards, in radians. It stops short of the
    /// poles.
    void orbit(const glm::dvec2& turned);

    /// Moves eye and target across the view, so that things at the distance of the target follow the mouse.
    /// @param moved  x to the right, y downwards, in units of the picture's height.
    void pan(const glm::dvec2& moved);

    /// Moves the eye towards the target, or away from it if `steps` is negative.
    void zoom(double steps);

private:
    optics::Camera camera_;
    double scene_size_;
};

}  // namespace cairn::app
