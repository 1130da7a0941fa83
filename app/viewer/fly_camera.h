#pragma once

#include <glm/glm.hpp>

#include "renderer/renderer.h"

namespace cairn::app {

/// A camera that moves freely. Until it is moved, it is the camera that it was made from. Its target stays at
/// the same distance, so that an OrbitCamera can take over.
class FlyCamera {
public:
    /// @param scene_size  diagonal of the scene in world units, > 0. The first speed is a quarter of it per
    /// second.
    FlyCamera(const optics::Camera& camera, double scene_size);

    [[nodiscard]] const optics::Camera& camera() const { return camera_; }
    [[nodiscard]] double speed() const { return speed_; }  ///< world units per second

    /// Turns the camera: x to the right, y downwards, in radians. It stops short of the poles.
    void look(const glm::dvec2& turned);

    /// Moves the camera. It is not faster along a diagonal.
    /// @param ways  directions: x to the right, y upwards, z ahead; 1, 0 or -1 each.
    void move(const glm::dvec3& ways, double seconds);

    /// Replaces the camera; the speed stays.
    void place(const optics::Camera& camera) { camera_ = camera; }

    /// Makes the camera faster, or slower if `steps` is negative.
    void change_speed(double steps);

private:
    optics::Camera camera_;
    double scene_size_;
    double speed_;
};

}  // namespace cairn::app
