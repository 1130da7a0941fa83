#include "bench/trials/soft_shadow_study.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "bench/trials/real_scenes.h"
#include "reference/shadow_truth.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

using glm::dvec3;

constexpr const char* square_path = "builtin:square";
constexpr double floor_half = 8.0;
constexpr double truth_standard_error = 1.0 / 512.0;

scenes::Scene scene_of(std::vector<scenes::Primitive> primitives) {
    scenes::Scene scene;
    scenes::Mesh mesh;
    mesh.primitives = std::move(primitives);
    scene.meshes.push_back(std::move(mesh));
    scenes::Node node;
    node.mesh = 0;
    scene.nodes.push_back(std::move(node));
    scene.scenes.push_back({"", {0}});
    return scene;
}

/// A horizontal square, its front upwards.
scenes::Primitive level_square(double half, double height) {
    scenes::Primitive primitive;
    for (const auto& [x, z] : {std::pair(-1.0, -1.0), {-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}})
        primitive.positions.emplace_back(dvec3(half * x, height, half * z));
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return primitive;
}

/// The scene in the world, scaled to a longest side of 1 and standing on y = 0.
scenes::Scene standing(const std::string& path) {
    if (path == square_path) return scene_of({level_square(0.5, 0.0)});
    const scenes::Scene scene = scenes::load(path);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const dvec3 extent = snapshot.bounds.high - snapshot.bounds.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (snapshot.triangle_count == 0 || !(longest > 0.0))
        throw Error(Fault::usage, path, "it has no triangles to cast a shadow");
    const dvec3 foot = snapshot.bounds.low + 0.5 * dvec3(extent.x, 0.0, extent.z);
    std::vector<scenes::Primitive> primitives;
    for (const scenes::Item& item : snapshot.items) {
        if (item.primitive->topology != scenes::Topology::triangles) continue;
        scenes::Primitive primitive;
        primitive.indices = item.primitive->indices;
        for (std::size_t vertex = 0; vertex < item.vertex_count(); ++vertex)
            primitive.positions.emplace_back((item.world(vertex) - foot) / longest);
        primitives.push_back(std::move(primitive));
    }
    return scene_of(std::move(primitives));
}

scenes::Primitive cut_in_parts(const scenes::Primitive& whole, int parts) {
    scenes::Primitive fine;
    for (std::size_t i = 0; i + 2 < whole.indices.size(); i += 3) {
        const dvec3 a(whole.positions[whole.indices[i]]);
        const dvec3 b(whole.positions[whole.indices[i + 1]]);
        const dvec3 c(whole.positions[whole.indices[i + 2]]);
        const auto first = std::uint32_t(fine.positions.size());
        const auto vertex = [&](int row, int column) {
            return first + std::uint32_t(row * (row + 1) / 2 + column);
        };
        for (int row = 0; row <= parts; ++row) {
            for (int column = 0; column <= row; ++column)
                fine.positions.emplace_back(a + ((b - a) * double(row - column) + (c - a) * double(column)) /
                                                    double(parts));
        }
        for (int row = 0; row < parts; ++row) {
            for (int column = 0; column <= row; ++column) {
                fine.indices.insert(fine.indices.end(), {vertex(row, column), vertex(row + 1, column),
                                                         vertex(row + 1, column + 1)});
                if (column < row)
                    fine.indices.insert(fine.indices.end(), {vertex(row, column), vertex(row + 1, column + 1),
                                                             vertex(row, column + 1)});
            }
        }
    }
    return fine;
}

/// The horizontal light of a placement.
optics::Light light_over(const ShadowPlacement& placement) {
    optics::Light light;
    light.positional = true;
    light.position = dvec3(-placement.lateral, study_light_height - placement.gap, 0.0);
    light.shape = optics::LightShape::rectangle;
    light.half_u = dvec3(0.5 * placement.light_width, 0.0, 0.0);
    light.half_v = dvec3(0.0, 0.0, 0.5 * placement.light_width);
    return light;
}

}  // namespace

ShadowOccluder::ShadowOccluder(const std::string& path) : ShadowOccluder(scene_name(path), standing(path)) {}

ShadowOccluder::ShadowOccluder(std::string name, scenes::Scene scene)
    : name_(std::move(name)),
      scene_(std::make_unique<scenes::Scene>(std::move(scene))),
      snapshot_(scenes::take_snapshot(*scene_)) {}

ShadowOccluder ShadowOccluder::cut(int parts) const {
    std::vector<scenes::Primitive> primitives;
    for (const scenes::Primitive& primitive : scene_->meshes[0].primitives)
        primitives.push_back(cut_in_parts(primitive, parts));
    return {name_, scene_of(std::move(primitives))};
}

/// The occluder stays at its place; light and floor are placed around it.
StudyCase::StudyCase(const ShadowOccluder& occluder, const ShadowPlacement& placement)
    : placement_(placement),
      light_(light_over(placement)),
      floor_(std::make_unique<scenes::Scene>(scene_of({level_square(floor_half, floor_height())}))),
      floor_snapshot_(scenes::take_snapshot(*floor_)),
      floor_mesh_(std::make_unique<renderer::ShadowMesh>(*floor_, floor_snapshot_)),
      fitted_(renderer::fit_shadow_frustum(light_, occluder.snapshot(), floor_snapshot_)) {}

renderer::ShadowFrustum StudyCase::frustum(StudyWindow window) const {
    renderer::ShadowFrustum frustum = fitted_;
    if (window == StudyWindow::shared) {
        frustum.occluders.low = glm::min(fitted_.occluders.low, fitted_.receivers.low);
        frustum.occluders.high = glm::max(fitted_.occluders.high, fitted_.receivers.high);
    }
    return frustum;
}

ShadowPoints shadow_points(const renderer::SoftShadowMap& map) {
    const renderer::ShadowMapValues depths = map.receiver_inverse_depths();
    const renderer::ShadowWindow& window = map.frustum().receivers;
    const glm::dmat4 world_from_light = glm::inverse(optics::light_from_world(map.light()));
    ShadowPoints points;
    for (int y = study_step / 2; y < depths.size; y += study_step) {
        for (int x = study_step / 2; x < depths.size; x += study_step) {
            const double inverse_depth = depths.at(x, y);
            if (!(inverse_depth > 0.0)) continue;
            const glm::dvec2 tangents =
                glm::mix(window.low, window.high, (glm::dvec2(x, y) + 0.5) / double(depths.size));
            points.texels.emplace_back(x, y);
            points.world.push_back(
                scenes::transform_point(world_from_light, dvec3(tangents, 1.0) / inverse_depth));
        }
    }
    return points;
}

std::vector<double> truth_at(const ShadowPoints& points, const reference::ImageTracer& occluder,
                             const optics::Light& light) {
    std::vector<double> truth;
    for (const reference::LightVisibility& there : reference::area_light_visibility(
             occluder, points.world, {}, light, {.standard_error = truth_standard_error}))
        truth.push_back(there.visible);
    return truth;
}

SoftShadowErrors soft_shadow_errors(const renderer::ShadowMapValues& visible, const ShadowPoints& points,
                                    const std::vector<double>& truth) {
    SoftShadowErrors errors;
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double found = visible.at(points.texels[i].x, points.texels[i].y);
        if (truth[i] >= 1.0 && found >= 1.0) continue;
        const double apart = std::abs(found - truth[i]);
        ++errors.shadowed;
        if (apart > 1.0 / 16.0) ++errors.wrong;
        sum += apart;
        squares += apart * apart;
        errors.greatest = std::max(errors.greatest, apart);
    }
    if (errors.shadowed == 0) return errors;
    errors.mean = sum / double(errors.shadowed);
    errors.rmse = std::sqrt(squares / double(errors.shadowed));
    return errors;
}

}  // namespace cairn::bench
