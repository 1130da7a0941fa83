#include "renderer/shadow/map_shadows.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "base/clock.h"
#include "base/error.h"
#include "optics/light.h"
#include "renderer/shadow/shadow_checks.h"
#include "renderer/shadow/shadow_mesh.h"
#include "renderer/shadow/shadow_projection.h"

namespace cairn::renderer {
namespace {

/// The near plane as far as the scene allows: depth is finest there.
glm::dmat4 clip_from_world(const View& view, const scenes::Bounds& bounds) {
    const glm::dmat4 camera = glm::lookAt(view.camera.eye, view.camera.target, view.camera.up);
    double nearest = 1e300;
    double furthest = 0.0;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1 ? bounds.high : bounds.low).x, (i & 2 ? bounds.high : bounds.low).y,
                                (i & 4 ? bounds.high : bounds.low).z);
        const double depth = -(camera * glm::dvec4(corner, 1.0)).z;
        nearest = std::min(nearest, depth);
        furthest = std::max(furthest, depth);
    }
    if (bounds.empty() || !(furthest > 0.0)) furthest = 1.0;
    // The far plane is so far behind the scene that rounding clips nothing, even with the nearest near plane.
    furthest *= 2.0;
    nearest = std::clamp(0.999 * nearest, 1e-5 * furthest, 0.999 * furthest);
    return glm::perspective(view.camera.yfov, view.size.aspect(), nearest, furthest) * camera;
}

[[noreturn]] void refuse(const char* what, const char* way_out) {
    throw Error(Fault::usage, "soft shadow map", what, way_out);
}

void check_map_view(const View& view) {
    check_view(view);
    check_shows_surface(view);
    check_one_ray(view);
    if (view.anchor) refuse("it has no tree for a camera to be anchored in", "give the camera in the world");
    if (view.shadow.kind != ShadowQuality::Kind::rays)
        refuse("its shadow is that of the whole light", "ask for a shadow by rays, or choose another method");
    static_cast<void>(optics::light_from_world(view.light));
}

void check_sides(const ShadowScene& scene) {
    check_selections(scene);
    const auto is_of = [](const std::optional<scenes::NodeSelection>& selection, std::size_t node) {
        return !selection || (*selection)[node];
    };
    const std::vector<scenes::Node>& nodes = scene.scene.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!is_of(scene.casters, i) || !is_of(scene.receivers, i) || nodes[i].mesh < 0) continue;
        throw Error(Fault::usage, scene.scene.name,
                    fmt::format("node {} \"{}\" is both occluder and receiver", i, nodes[i].name),
                    "soft shadow maps have no self-shadowing: let it be one of them");
    }
}

scenes::Snapshot part_of(const scenes::Snapshot& snapshot, const scenes::Scene& scene,
                         const std::optional<scenes::NodeSelection>& selection) {
    return scenes::part_of(snapshot, selection.value_or(scenes::NodeSelection(scene.nodes.size(), true)));
}

/// Occluders and receivers at one moment.
struct MapSides {
    MapSides(const ShadowScene& scene, const scenes::Snapshot& snapshot)
        : occluders(part_of(snapshot, scene.scene, scene.casters)),
          receivers(part_of(snapshot, scene.scene, scene.receivers)),
          occluder_mesh(scene.scene, occluders),
          receiver_mesh(scene.scene, receivers) {
        for (const scenes::Bounds& part : {occluders.bounds, receivers.bounds}) {
            if (part.empty()) continue;
            bounds.add(part.low);
            bounds.add(part.high);
        }
    }

    scenes::Snapshot occluders, receivers;
    scenes::Bounds bounds;
    ShadowMesh occluder_mesh, receiver_mesh;
};

}  // namespace

struct MapShadows::Impl {
    Impl(const ShadowScene& shown, const SoftShadowOptions& options, const gl::ShaderSource& shaders)
        : scene(shown), map(options, shaders), projection(shaders) {
        sides.emplace(scene, scene.snapshot);
    }

    ShadowScene scene;
    scenes::Snapshot moved;  ///< after a move: the snapshot that `sides` refers to
    std::optional<MapSides> sides;
    SoftShadowMap map;
    ShadowProjection projection;
    std::optional<ShadowFrustum> frustum;
    std::vector<float> distances;
    double move_ms = 0.0;  ///< time of moves since the last picture
};

MapShadows::MapShadows(const ShadowScene& scene, const SoftShadowOptions& options,
                       const gl::ShaderSource& shaders) {
    check_sides(scene);
    impl_ = std::make_unique<Impl>(scene, options, shaders);
}
MapShadows::~MapShadows() = default;

void MapShadows::move_to(double seconds) {
    Impl& impl = *impl_;
    if (!impl.scene.motion) ShadowRenderer::move_to(seconds);
    const auto start = Clock::now();
    scenes::When when = impl.scene.motion->when;
    when.seconds = seconds;
    scenes::Snapshot snapshot = scenes::take_snapshot(impl.scene.scene, when);
    impl.sides.reset();
    impl.moved = std::move(snapshot);
    impl.sides.emplace(impl.scene, impl.moved);
    glFinish();
    impl.move_ms += milliseconds_since(start);
}

ShadowPicture MapShadows::render(const View& view, const ShadowRequest& request) {
    check_map_view(view);
    Impl& impl = *impl_;
    const auto start = Clock::now();
    const MapSides& sides = *impl.sides;
    const ShadowFrustum frustum =
        impl.frustum ? *impl.frustum : fit_shadow_frustum(view.light, sides.occluders, sides.receivers);
    impl.map.compute(view.light, frustum, sides.occluder_mesh, sides.receiver_mesh);
    ProjectedPixels pixels = impl.projection.draw({.width = view.size.width,
                                                   .height = view.size.height,
                                                   .eye = view.camera.eye,
                                                   .clip_from_world = clip_from_world(view, sides.bounds),
                                                   .background = view.background,
                                                   .light_color = view.light.color,
                                                   .ambient = view.light.ambient},
                                                  impl.map, sides.occluder_mesh, sides.receiver_mesh);
    ShadowPicture picture;
    if (request.image) picture.image = {view.size.width, view.size.height, std::move(pixels.rgba)};
    if (request.light) picture.light = {view.size.width, view.size.height, std::move(pixels.visible)};
    impl.distances = std::move(pixels.distance);
    picture.times.move_ms = std::exchange(impl.move_ms, 0.0);
    picture.times.shadow_ms = impl.map.statistics().milliseconds;
    picture.times.milliseconds = picture.times.move_ms + milliseconds_since(start);
    return picture;
}

void MapShadows::set_frustum(const std::optional<ShadowFrustum>& frustum) {
    impl_->frustum = frustum;
}

const SoftShadowMap& MapShadows::map() const {
    return impl_->map;
}

const std::vector<float>& MapShadows::distances() const {
    return impl_->distances;
}

}  // namespace cairn::renderer
