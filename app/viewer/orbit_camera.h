#pragma once

#include <glm/glm.hpp>

#include "renderer/renderer.h"

namespace cairn::app {

/// A camera that turns about the point it looks at. Until it is moved it is the camera that it was made of.
class OrbitCamera {
public:
    /// @param scene_size  the diagonal of the scene, world units, > 0: bounds how near and how far it can go.
    OrbitCamera(const optics::Camera& camera, double scene_size);

    [[nodiscard]] const optics::Camera& camera() const { return camera_; }

    /// Turns the scene as if grabbed: x to the right, y downwards, in radians. It stops short of the poles.
    void orbit(const glm::dvec2& turned);

    /// Moves eye and target across the view, so that what is as far away as the target follows the mouse.
    /// @param moved  x to the right, y downwards, in heights of the picture.
    void pan(const glm::dvec2& moved);

    /// Brings the eye nearer to the target, or away from it where `steps` is negative.
    void zoom(double steps);

private:
    optics::Camera camera_;
    double scene_size_;
};

}  // namespace cairn::app
