#include "renderer/soft_shadow.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
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
    // So far behind all that is there that it is not clipped by rounding, were the near plane the least.
    furthest *= 2.0;
    nearest = std::clamp(0.999 * nearest, 1e-5 * furthest, 0.999 * furthest);
    return glm::perspective(view.camera.yfov, double(view.width) / view.height, nearest, furthest) * camera;
}

void check(const View& view) {
    if (view.width >= 1 && view.height >= 1 && view.width <= 16384 && view.height <= 16384) return;
    throw Error(Fault::usage, "soft shadow", fmt::format("a picture of {}x{}", view.width, view.height),
                "choose 1 to 16384 pixels a side");
}

}  // namespace

struct SoftShadowRenderer::Parts {
    Parts(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
          const scenes::NodeSelection& occluding, const scenes::NodeSelection& receiving,
          const SoftShadowOptions& options, const gl::ShaderSource& shaders)
        : occluders(scenes::part_of(snapshot, occluding)),
          receivers(scenes::part_of(snapshot, receiving)),
          occluder_mesh(scene, occluders),
          receiver_mesh(scene, receivers),
          map(options, shaders),
          projection(shaders) {
        for (const scenes::Bounds& part : {occluders.bounds, receivers.bounds}) {
            if (part.empty()) continue;
            bounds.add(part.low);
            bounds.add(part.high);
        }
    }

    scenes::Snapshot occluders, receivers;
    scenes::Bounds bounds;
    ShadowMesh occluder_mesh, receiver_mesh;
    SoftShadowMap map;
    ShadowProjection projection;
};

SoftShadowRenderer::SoftShadowRenderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                       const scenes::NodeSelection& occluders,
                                       const scenes::NodeSelection& receivers,
                                       const SoftShadowOptions& options, const gl::ShaderSource& shaders) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (!occluders[i] || !receivers[i] || scene.nodes[i].mesh < 0) continue;
        throw Error(Fault::usage, scene.name,
                    fmt::format("node {} \"{}\" is both occluder and receiver", i, scene.nodes[i].name),
                    "soft shadow maps know no self-shadowing: let it be one of them");
    }
    parts_ = std::make_unique<Parts>(scene, snapshot, occluders, receivers, options, shaders);
}
SoftShadowRenderer::SoftShadowRenderer(SoftShadowRenderer&&) noexcept = default;
SoftShadowRenderer& SoftShadowRenderer::operator=(SoftShadowRenderer&&) noexcept = default;
SoftShadowRenderer::~SoftShadowRenderer() = default;

SoftShadowPicture SoftShadowRenderer::render(const View& view, const std::optional<ShadowFrustum>& frustum) {
    check(view);
    Parts& parts = *parts_;
    parts.map.compute(view.light,
                      frustum ? *frustum : fit_shadow_frustum(view.light, parts.occluders, parts.receivers),
                      parts.occluder_mesh, parts.receiver_mesh);
    ProjectedPixels pixels = parts.projection.draw({.width = view.width,
                                                    .height = view.height,
                                                    .eye = view.camera.eye,
                                                    .clip_from_world = clip_from_world(view, parts.bounds),
                                                    .background = view.background,
                                                    .light_color = view.light.color,
                                                    .ambient = view.light.ambient},
                                                   parts.map, parts.occluder_mesh, parts.receiver_mesh);
    return {{view.width, view.height, std::move(pixels.rgba)},
            std::move(pixels.visible),
            std::move(pixels.distance)};
}

const SoftShadowMap& SoftShadowRenderer::map() const {
    return parts_->map;
}

}  // namespace cairn::renderer
