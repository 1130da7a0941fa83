#include "voxelizer/surface/far_clip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::voxelizer {
namespace {

/// A convex part of a triangle, as weights of its vertices.
using Polygon = std::vector<glm::dvec3>;

/// The part where the weighted sum of `inside` is not negative: Sutherland and Hodgman 1974.
Polygon clip(const Polygon& polygon, const glm::dvec3& inside) {
    Polygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& p = polygon[i];
        const glm::dvec3& q = polygon[(i + 1) % polygon.size()];
        const double at_p = glm::dot(p, inside);
        const double at_q = glm::dot(q, inside);
        if (at_p >= 0.0) out.push_back(p);
        if ((at_p < 0.0) != (at_q < 0.0)) out.push_back(glm::mix(p, q, at_p / (at_p - at_q)));
    }
    return out;
}

Polygon part_in_box(const FarTriangle& triangle, const glm::dvec3& low, const glm::dvec3& high) {
    Polygon polygon = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const auto& [a, b, c] = triangle.positions;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 p(a[axis], b[axis], c[axis]);
        polygon = clip(clip(polygon, p - low[axis]), high[axis] - p);
    }
    return polygon;
}

void add_vertex(const FarTriangle& triangle, const glm::dvec3& weights, SurfaceChunk& out) {
    glm::dvec3 position(0.0);
    glm::dvec2 texcoord(0.0);
    glm::dvec4 color(0.0);
    for (int i = 0; i < 3; ++i) {
        position += weights[i] * glm::dvec3(triangle.positions[std::size_t(i)]);
        texcoord += weights[i] * glm::dvec2(triangle.texcoords[std::size_t(i)]);
        color += weights[i] * glm::dvec4(triangle.colors[std::size_t(i)]);
    }
    out.positions.push_back(
        {int(std::lround(position.x)), int(std::lround(position.y)), int(std::lround(position.z))});
    const glm::u16vec4 rounded(glm::round(glm::clamp(color, 0.0, 65535.0)));
    out.attributes.push_back(surface_attributes(0, rounded, glm::vec2(texcoord)));
}

constexpr double range_low = -double(1 << LATTICE_BITS);
constexpr double range_high = 2.0 * double(1 << LATTICE_BITS);

SurfaceChunk clipped_to(std::span<const FarTriangle> triangles, const glm::dvec3& low,
                        const glm::dvec3& high) {
    SurfaceChunk pieces;
    for (const FarTriangle& triangle : triangles) {
        const Polygon polygon = part_in_box(triangle, low, high);
        const auto first = std::uint32_t(pieces.positions.size());
        for (const glm::dvec3& weights : polygon)
            add_vertex(triangle, weights, pieces);
        for (std::uint32_t i = 2; i < polygon.size(); ++i)
            pieces.triangles.push_back({{first, first + i - 1, first + i}, triangle.material});
    }
    return pieces;
}

}  // namespace

SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles) {
    return clipped_to(triangles, glm::dvec3(range_low), glm::dvec3(range_high));
}

SurfaceChunk clip_far_triangles(std::span<const FarTriangle> triangles, const Region& region) {
    const double side = region.voxel_side();
    return clipped_to(triangles, glm::max(glm::dvec3(region.origin - 1) * side, glm::dvec3(range_low)),
                      glm::min(glm::dvec3(region.origin + region.size + 1) * side, glm::dvec3(range_high)));
}

}  // namespace cairn::voxelizer
