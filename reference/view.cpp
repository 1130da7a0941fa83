#include "reference/view.h"

#include <cmath>

namespace cairn::reference {
namespace {

constexpr double far_away = 1e5;

}  // namespace

ReferenceCamera camera_of(const optics::Camera& camera) {
    return {camera.eye, camera.target, camera.up, camera.yfov};
}

ReferenceLight light_of(const optics::Light& light) {
    return {light.positional, light.position, light.towards};
}

AreaLight area_light_of(const optics::Light& light, const scenes::Bounds& scene) {
    AreaLight area;
    area.shape = AreaLight::Shape::sphere;
    if (!light.positional) {
        const double distance = far_away * glm::length(scene.high - scene.low);
        area.centre = 0.5 * (scene.low + scene.high) + distance * glm::normalize(light.towards);
        area.radius = distance * std::sin(light.angle);
        return area;
    }
    area.centre = light.position;
    area.radius = light.radius;
    if (light.shape != optics::LightShape::sphere) {
        area.shape =
            light.shape == optics::LightShape::disk ? AreaLight::Shape::disk : AreaLight::Shape::rectangle;
        area.half_u = light.half_u;
        area.half_v = light.half_v;
    }
    return area;
}

}  // namespace cairn::reference
