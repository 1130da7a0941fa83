#include "bench/trials/shadow_scene.h"

#include <algorithm>
#include <utility>

#include "bench/trials/real_scenes.h"
#include "scenes/load.h"

namespace cairn::bench {
namespace {

// Lengths are in units of the scene's diagonal.
const glm::dvec3 to_light(-0.6, 1.0, 0.15);
constexpr double light_distance = 1.5;
constexpr double light_side = 0.2;
/// Gap below the scene, so that no triangle is in the ground's plane.
constexpr double ground_gap = 0.002;
constexpr double ground_margin = 0.15;

/// Offset on the ground of the shadow of the bounds' top from their foot.
glm::dvec3 shadow_fall(const scenes::Bounds& bounds) {
    const double height = bounds.high.y - bounds.low.y;
    return glm::dvec3(-to_light.x, 0.0, -to_light.z) * (height / to_light.y);
}

/// Adds a ground below the scene and below the shadow of its bounds.
void add_ground(scenes::Scene& scene, const scenes::Bounds& bounds) {
    const double diagonal = glm::length(bounds.high - bounds.low);
    const glm::dvec3 fall = shadow_fall(bounds);
    const glm::dvec3 low = glm::min(bounds.low, bounds.low + fall) - ground_margin * diagonal;
    const glm::dvec3 high = glm::max(bounds.high, bounds.high + fall) + ground_margin * diagonal;
    const double y = bounds.low.y - ground_gap * diagonal;
    scenes::Primitive quad;
    for (const auto& [x, z] : {std::pair{low.x, low.z}, std::pair{low.x, high.z}, std::pair{high.x, high.z},
                               std::pair{high.x, low.z}})
        quad.positions.emplace_back(x, y, z);
    quad.indices = {0, 1, 2, 0, 2, 3};
    scenes::Mesh mesh;
    mesh.primitives.push_back(std::move(quad));
    scene.meshes.push_back(std::move(mesh));
    scenes::Node node;
    node.name = "ground";
    node.mesh = int(scene.meshes.size()) - 1;
    scene.nodes.push_back(std::move(node));
    scene.scenes[std::size_t(scene.default_scene)].nodes.push_back(int(scene.nodes.size()) - 1);
}

optics::Light light_over(const scenes::Bounds& bounds) {
    const double diagonal = glm::length(bounds.high - bounds.low);
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const glm::dvec3 position = centre + light_distance * diagonal * glm::normalize(to_light);
    return optics::aimed_light(position, centre, light_side * diagonal, light_side * diagonal);
}

/// A camera as far away as optics::framing_camera(), but higher, so that more of the shadow shows.
optics::Camera camera_above(const scenes::Bounds& bounds, double aspect) {
    optics::Camera camera = optics::framing_camera(bounds, aspect);
    const double distance = glm::distance(camera.eye, camera.target);
    camera.eye = camera.target + distance * glm::normalize(glm::dvec3(0.3, 0.7, 1.0));
    return camera;
}

}  // namespace

ShadowScene::ShadowScene(const std::string& path, bool with_ground)
    : name_(scene_name(path)), scene_(scenes::load(path)) {
    const scenes::Bounds bounds = scenes::take_snapshot(scene_).bounds;
    light_ = light_over(bounds);
    framed_ = bounds;
    ground_nodes_.assign(scene_.nodes.size(), false);
    if (with_ground) {
        add_ground(scene_, bounds);
        framed_.add(bounds.low + shadow_fall(bounds) * 0.5);
        framed_.add(bounds.high + shadow_fall(bounds) * 0.5 -
                    glm::dvec3(0.0, bounds.high.y - bounds.low.y, 0.0));
        ground_nodes_.push_back(true);
    }
    caster_nodes_ = scenes::other_nodes(ground_nodes_);
    all_ = scenes::take_snapshot(scene_);
    casters_ = scenes::part_of(all_, caster_nodes_);
}

renderer::ShadowScene ShadowScene::shadow_scene(renderer::ShadowMethod method) const {
    if (method != renderer::ShadowMethod::soft_shadow_map) return {scene_, all_};
    return {scene_, all_, caster_nodes_, ground_nodes_};
}

renderer::View ShadowScene::view(int width, int height, int rays) const {
    renderer::View view;
    view.size = {width, height};
    view.camera = camera_above(framed_, double(width) / height);
    view.light = light_;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
    return view;
}

}  // namespace cairn::bench
