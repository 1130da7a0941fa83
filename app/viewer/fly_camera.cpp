#include "app/viewer/fly_camera.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace cairn::app {
namespace {

constexpr double highest = glm::radians(89.0);
constexpr double faster_a_step = 1.25;
/// Speeds in scene sizes per second.
constexpr double first_speed = 0.25;
constexpr double least_speed = 1e-5;
constexpr double largest_speed = 10.0;

}  // namespace

FlyCamera::FlyCamera(const optics::Camera& camera, double scene_size)
    : camera_(camera), scene_size_(scene_size), speed_(first_speed * scene_size) {}

void FlyCamera::look(const glm::dvec2& turned) {
    const glm::dvec3 ahead = camera_.target - camera_.eye;
    const double distance = glm::length(ahead);
    const bool is_vertical = std::abs(ahead.x) + std::abs(ahead.z) < 1e-9 * distance;
    // If the camera looks straight down, "up" in the picture is the direction ahead once it is raised.
    const glm::dvec3 level = is_vertical ? camera_.up : ahead;
    const double azimuth = std::atan2(level.x, level.z) - turned.x;
    const double elevation =
        std::clamp(std::asin(std::clamp(ahead.y / distance, -1.0, 1.0)) - turned.y, -highest, highest);
    const glm::dvec3 direction(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                               std::cos(elevation) * std::cos(azimuth));
    camera_.target = camera_.eye + distance * direction;
    camera_.up = {0.0, 1.0, 0.0};
}

void FlyCamera::move(const glm::dvec3& ways, double seconds) {
    if (ways == glm::dvec3(0.0)) return;
    const glm::dvec3 forward = glm::normalize(camera_.target - camera_.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera_.up));
    const glm::dvec3 way = ways.x * right + ways.y * camera_.up + ways.z * forward;
    if (glm::length(way) < 1e-9) return;  // two keys that cancel out
    const glm::dvec3 shift = speed_ * seconds * glm::normalize(way);
    camera_.eye += shift;
    camera_.target += shift;
}

void FlyCamera::change_speed(double steps) {
    speed_ = std::clamp(speed_ * std::pow(faster_a_step, steps), least_speed * scene_size_,
                        largest_speed * scene_size_);
}

}  // namespace cairn::app
