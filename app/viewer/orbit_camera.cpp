#include "app/viewer/orbit_camera.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace cairn::app {
namespace {

constexpr double highest = glm::radians(89.0);
constexpr double nearer_a_step = 0.88;
/// Distances of the eye from the target, in sizes of the scene.
constexpr double least_distance = 1e-6;
constexpr double largest_distance = 1e3;

}  // namespace

OrbitCamera::OrbitCamera(const optics::Camera& camera, double scene_size)
    : camera_(camera), scene_size_(scene_size) {}

void OrbitCamera::orbit(const glm::dvec2& turned) {
    const glm::dvec3 back = camera_.eye - camera_.target;
    const double distance = glm::length(back);
    // From straight above, the camera's up direction is -Z: the azimuth of an eye on the side of +Z.
    const double azimuth = std::atan2(back.x, back.z) - turned.x;
    const double elevation =
        std::clamp(std::asin(std::clamp(back.y / distance, -1.0, 1.0)) + turned.y, -highest, highest);
    const glm::dvec3 direction(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                               std::cos(elevation) * std::cos(azimuth));
    camera_.eye = camera_.target + distance * direction;
    camera_.up = {0.0, 1.0, 0.0};
}

void OrbitCamera::pan(const glm::dvec2& moved) {
    const glm::dvec3 forward = camera_.target - camera_.eye;
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera_.up));
    const glm::dvec3 up = glm::normalize(glm::cross(right, forward));
    const double height = 2.0 * glm::length(forward) * std::tan(0.5 * camera_.yfov);
    const glm::dvec3 shift = height * (moved.y * up - moved.x * right);
    camera_.eye += shift;
    camera_.target += shift;
}

void OrbitCamera::zoom(double steps) {
    const glm::dvec3 back = camera_.eye - camera_.target;
    const double distance = glm::length(back);
    const double wanted = distance * std::pow(nearer_a_step, steps);
    camera_.eye =
        camera_.target +
        back / distance * std::clamp(wanted, least_distance * scene_size_, largest_distance * scene_size_);
}

}  // namespace cairn::app
