#pragma once

#include <glm/glm.hpp>

#include "renderer/renderer.h"

namespace cairn::app {

/// A camera that moves freely. Until it is moved it is the camera that it was made of; its target stays as
/// far ahead as it was, so that an orbit can go on about it.
class FlyCamera {
public:
    /// @param scene_size  the diagonal of the scene, world units, > 0: it starts with a quarter of it a
    /// second.
    FlyCamera(const optics::Camera& camera, double scene_size);

    [[nodiscard]] const optics::Camera& camera() const { return camera_; }
    [[nodiscard]] double speed() const { return speed_; }  ///< world units a second

    /// Turns the head: x to the right, y downwards, in radians. It stops short of the poles.
    void look(const glm::dvec2& turned);

    /// @param ways  x to the right, y upwards, z ahead: 1, 0 or -1 each. Not faster when two ways join.
    void move(const glm::dvec3& ways, double seconds);

    /// Puts it elsewhere, at the same speed.
    void place(const optics::Camera& camera) { camera_ = camera; }

    /// Faster, or slower where `steps` is negative.
    void change_speed(double steps);

private:
    optics::Camera camera_;
    double scene_size_;
    double speed_;
};

}  // namespace cairn::app
