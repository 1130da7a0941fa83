#include "tests/support/soft_shadow_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace cairn::test {
namespace {

using glm::dvec2;
using glm::dvec3;

int add_node(scenes::Scene& scene, std::string name, const Corners& corners) {
    scenes::Primitive primitive;
    for (const dvec3& corner : corners)
        primitive.positions.emplace_back(corner);
    primitive.indices.resize(corners.size());
    std::iota(primitive.indices.begin(), primitive.indices.end(), 0U);
    scenes::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    scenes::Node node;
    node.name = std::move(name);
    node.mesh = int(scene.meshes.size()) - 1;
    scene.nodes.push_back(std::move(node));
    return int(scene.nodes.size()) - 1;
}

void add_patch(Corners& corners, const dvec3& centre, double radius, dvec3 a, dvec3 b, dvec3 c, int depth) {
    if (depth == 0) {
        for (const dvec3& corner : {a, b, c})
            corners.push_back(centre + radius * corner);
        return;
    }
    const dvec3 ab = glm::normalize(a + b);
    const dvec3 bc = glm::normalize(b + c);
    const dvec3 ca = glm::normalize(c + a);
    add_patch(corners, centre, radius, a, ab, ca, depth - 1);
    add_patch(corners, centre, radius, b, bc, ab, depth - 1);
    add_patch(corners, centre, radius, c, ca, bc, depth - 1);
    add_patch(corners, centre, radius, ab, bc, ca, depth - 1);
}

/// The part of a polygon where sign * p[axis] <= limit (Sutherland and Hodgman 1974).
std::vector<dvec2> clipped(const std::vector<dvec2>& polygon, int axis, double sign, double limit) {
    std::vector<dvec2> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec2 a = polygon[i];
        const dvec2 b = polygon[(i + 1) % polygon.size()];
        const double over_a = sign * a[axis] - limit;
        const double over_b = sign * b[axis] - limit;
        if (over_a <= 0.0) kept.push_back(a);
        if ((over_a <= 0.0) != (over_b <= 0.0)) kept.push_back(glm::mix(a, b, over_a / (over_a - over_b)));
    }
    return kept;
}

}  // namespace

Corners quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return {a, b, c, a, c, d};
}

Corners square(const dvec3& centre, double half, double angle) {
    const dvec3 u = half * dvec3(std::cos(angle), 0.0, std::sin(angle));
    const dvec3 v = half * dvec3(-std::sin(angle), 0.0, std::cos(angle));
    return quad(centre - u - v, centre - u + v, centre + u + v, centre + u - v);
}

Corners box(const dvec3& low, const dvec3& high) {
    Corners corners;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool top : {false, true}) {
            std::array<dvec3, 4> face;
            for (int k = 0; k < 4; ++k) {
                dvec3& p = face[std::size_t(k)];
                p[axis] = top ? high[axis] : low[axis];
                const int next = (axis + 1) % 3;
                const int last = (axis + 2) % 3;
                p[next] = (k == 1 || k == 2) ? high[next] : low[next];
                p[last] = k >= 2 ? high[last] : low[last];
            }
            const Corners two =
                top ? quad(face[0], face[1], face[2], face[3]) : quad(face[3], face[2], face[1], face[0]);
            corners.insert(corners.end(), two.begin(), two.end());
        }
    }
    return corners;
}

Corners ball(const dvec3& centre, double radius, int depth) {
    Corners corners;
    for (int octant = 0; octant < 8; ++octant) {
        const dvec3 x((octant & 1) != 0 ? -1.0 : 1.0, 0.0, 0.0);
        const dvec3 y(0.0, (octant & 2) != 0 ? -1.0 : 1.0, 0.0);
        const dvec3 z(0.0, 0.0, (octant & 4) != 0 ? -1.0 : 1.0);
        const bool turned = x.x * y.y * z.z < 0.0;
        add_patch(corners, centre, radius, x, turned ? z : y, turned ? y : z, depth);
    }
    return corners;
}

ShadowScene::ShadowScene(const Corners& occluder_corners, const Corners& receiver_corners) {
    scene.name = "shadow scene";
    scene.scenes.push_back({"", {add_node(scene, "floor", receiver_corners)}});
    if (!occluder_corners.empty())
        scene.scenes[0].nodes.push_back(add_node(scene, "thing", occluder_corners));
    whole = scenes::take_snapshot(scene);
    scenes::NodeSelection floor(scene.nodes.size(), false);
    floor[0] = true;
    receivers = scenes::part_of(whole, floor);
    occluders = scenes::part_of(whole, scenes::other_nodes(floor));
}

optics::Light light_above(double height, double half_x, double half_z) {
    return {.positional = true,
            .position = {0.0, height, 0.0},
            .shape = optics::LightShape::rectangle,
            .half_u = {half_x, 0.0, 0.0},
            .half_v = {0.0, 0.0, half_z}};
}

renderer::SoftShadowMap shadow_of(const ShadowScene& scene, const optics::Light& light,
                                  const renderer::SoftShadowOptions& options,
                                  const renderer::ShadowFrustum& frustum) {
    const renderer::ShadowMesh occluders(scene.scene, scene.occluders);
    const renderer::ShadowMesh receivers(scene.scene, scene.receivers);
    renderer::SoftShadowMap map(options);
    map.compute(light, frustum, occluders, receivers);
    return map;
}

renderer::SoftShadowMap shadow_of(const ShadowScene& scene, const optics::Light& light,
                                  const renderer::SoftShadowOptions& options) {
    return shadow_of(scene, light, options,
                     renderer::fit_shadow_frustum(light, scene.occluders, scene.receivers));
}

std::vector<ReceiverPoint> receiver_points(const renderer::SoftShadowMap& map) {
    const renderer::ShadowMapValues depths = map.receiver_inverse_depths();
    const renderer::ShadowMapValues visible = map.visible();
    const renderer::ShadowWindow window = map.frustum().receivers;
    std::vector<ReceiverPoint> points;
    for (int y = 0; y < depths.size; ++y) {
        for (int x = 0; x < depths.size; ++x) {
            const double w = depths.at(x, y);
            if (!(w > 0.0)) continue;
            const dvec2 tangents =
                glm::mix(window.low, window.high, (dvec2(x, y) + 0.5) / double(depths.size));
            points.push_back({x, y, dvec3(tangents, 1.0) / w, visible.at(x, y)});
        }
    }
    return points;
}

ShadowError error_of(const std::vector<ReceiverPoint>& points, const std::vector<double>& truth) {
    ShadowError error;
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ReceiverPoint& point = points[i];
        if (truth[i] >= 1.0 && point.visible >= 1.0) continue;
        ++error.shadowed;
        const double difference = std::abs(truth[i] - point.visible);
        sum += difference;
        if (difference <= error.greatest) continue;
        error.greatest = difference;
        error.worst =
            fmt::format("texel ({}, {}), light space ({}, {}, {}): {} instead of {}", point.x, point.y,
                        point.position.x, point.position.y, point.position.z, point.visible, truth[i]);
    }
    if (error.shadowed > 0) error.mean = sum / double(error.shadowed);
    return error;
}

double visible_past(const std::vector<dvec2>& polygon, double depth, const dvec3& point,
                    const dvec2& light_half) {
    if (depth >= point.z) return 1.0;
    std::vector<dvec2> shadow;
    for (const dvec2& corner : polygon)
        shadow.push_back(dvec2(point) + (corner - dvec2(point)) * (point.z / (point.z - depth)));
    for (int axis = 0; axis < 2; ++axis) {
        for (const double sign : {-1.0, 1.0})
            shadow = clipped(shadow, axis, sign, light_half[axis]);
    }
    double doubled = 0.0;
    for (std::size_t i = 0; i < shadow.size(); ++i) {
        const dvec2 a = shadow[i];
        const dvec2 b = shadow[(i + 1) % shadow.size()];
        doubled += a.x * b.y - a.y * b.x;
    }
    return 1.0 - 0.5 * std::abs(doubled) / (4.0 * light_half.x * light_half.y);
}

}  // namespace cairn::test
