#include "renderer/shadow/shadow_frustum.h"

#include <algorithm>
#include <array>

namespace cairn::renderer {
namespace {

/// Bounds of the tangents and depths of triangles, behind the near plane.
struct ViewBounds {
    glm::dvec2 low{1e300};
    glm::dvec2 high{-1e300};
    double least_depth = 1e300;
    double greatest_depth = 0.0;

    void add(const glm::dvec3& p) {
        const glm::dvec2 tangents = glm::clamp(glm::dvec2(p) / p.z, -max_shadow_tangent, max_shadow_tangent);
        low = glm::min(low, tangents);
        high = glm::max(high, tangents);
        least_depth = std::min(least_depth, p.z);
        greatest_depth = std::max(greatest_depth, p.z);
    }
    void add_edge(const glm::dvec3& a, const glm::dvec3& b, double near_distance) {
        if (a.z >= near_distance) add(a);
        if ((a.z >= near_distance) == (b.z >= near_distance)) return;
        glm::dvec3 crossing = glm::mix(a, b, (near_distance - a.z) / (b.z - a.z));
        crossing.z = near_distance;
        add(crossing);
    }
    [[nodiscard]] bool nothing() const { return low.x > high.x; }
};

ViewBounds bounds_of(const glm::dmat4& from_world, const scenes::Snapshot& snapshot, double near_distance) {
    ViewBounds seen;
    for (const scenes::Item& item : snapshot.items) {
        const scenes::Primitive& primitive = *item.primitive;
        if (primitive.topology != scenes::Topology::triangles) continue;
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            std::array<glm::dvec3, 3> corners;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k] = glm::dvec3(from_world * glm::dvec4(item.world(primitive.indices[i + k]), 1.0));
            for (std::size_t k = 0; k < 3; ++k)
                seen.add_edge(corners[k], corners[(k + 1) % 3], near_distance);
        }
    }
    return seen;
}

double greatest_depth(const glm::dmat4& from_world, const scenes::Snapshot& snapshot) {
    double depth = 0.0;
    if (snapshot.bounds.empty()) return depth;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1 ? snapshot.bounds.high : snapshot.bounds.low).x,
                                (i & 2 ? snapshot.bounds.high : snapshot.bounds.low).y,
                                (i & 4 ? snapshot.bounds.high : snapshot.bounds.low).z);
        depth = std::max(depth, (from_world * glm::dvec4(corner, 1.0)).z);
    }
    return depth;
}

/// A window with an extent along both axes, even around a sheet that is seen edge-on.
ShadowWindow window_of(glm::dvec2 low, glm::dvec2 high) {
    constexpr double least = 1e-5;
    for (int axis = 0; axis < 2; ++axis) {
        if (high[axis] - low[axis] >= least) continue;
        const double middle = 0.5 * (low[axis] + high[axis]);
        low[axis] = middle - 0.5 * least;
        high[axis] = middle + 0.5 * least;
    }
    return {low, high};
}

}  // namespace

ShadowFrustum fit_shadow_frustum(const optics::Light& light, const scenes::Snapshot& occluders,
                                 const scenes::Snapshot& receivers, double near_distance) {
    const glm::dmat4 from_world = optics::light_from_world(light);
    ShadowFrustum frustum;
    frustum.near_distance = near_distance;
    if (!(near_distance > 0.0)) {
        const double depth =
            std::max(greatest_depth(from_world, occluders), greatest_depth(from_world, receivers));
        frustum.near_distance = depth > 0.0 ? 1e-3 * depth : 1.0;
    }
    const ViewBounds occluder_bounds = bounds_of(from_world, occluders, frustum.near_distance);
    const ViewBounds receiver_bounds = bounds_of(from_world, receivers, frustum.near_distance);
    if (!occluder_bounds.nothing()) frustum.occluders = window_of(occluder_bounds.low, occluder_bounds.high);
    if (receiver_bounds.nothing()) return frustum;
    frustum.receivers = window_of(receiver_bounds.low, receiver_bounds.high);
    if (occluder_bounds.nothing()) return frustum;
    // Penumbra extents reach furthest for the nearest occluder and the furthest receiver (Atty et al., 3.3).
    const glm::dvec2 reach =
        optics::half_size(light) *
        std::max(0.0, 1.0 / occluder_bounds.least_depth - 1.0 / receiver_bounds.greatest_depth);
    const glm::dvec2 low = glm::max(receiver_bounds.low, occluder_bounds.low - reach);
    const glm::dvec2 high = glm::min(receiver_bounds.high, occluder_bounds.high + reach);
    if (low.x < high.x && low.y < high.y) frustum.receivers = window_of(low, high);
    return frustum;
}

}  // namespace cairn::renderer
