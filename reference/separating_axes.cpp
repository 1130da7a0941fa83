#include "reference/separating_axes.h"

#include <algorithm>

#include "voxelizer/surface/wide_integer.h"

namespace cairn::reference {
namespace {

using voxelizer::Int128;
using voxelizer::Wide3;

bool separates(const Wide3& axis, const std::array<Wide3, 3>& triangle, const glm::i64vec3& size) {
    const Int128 a = dot(axis, triangle[0]);
    const Int128 b = dot(axis, triangle[1]);
    const Int128 c = dot(axis, triangle[2]);
    Int128 low = 0;
    Int128 high = 0;
    for (const Int128 extent : {axis.x * size.x, axis.y * size.y, axis.z * size.z})
        (extent < 0 ? low : high) += extent;
    return std::min({a, b, c}) > high || std::max({a, b, c}) < low;
}

}  // namespace

bool triangle_meets_box(const std::array<glm::i64vec3, 3>& triangle, const glm::i64vec3& low,
                        const glm::i64vec3& high) {
    const auto& [a, b, c] = triangle;
    if (glm::any(glm::greaterThan(glm::min(glm::min(a, b), c), high))) return false;
    if (glm::any(glm::lessThan(glm::max(glm::max(a, b), c), low))) return false;
    const auto wide = [](const glm::i64vec3& v) { return Wide3{v.x, v.y, v.z}; };
    const std::array<Wide3, 3> corners = {wide(a - low), wide(b - low), wide(c - low)};
    const std::array<Wide3, 3> edges = {wide(b - a), wide(c - b), wide(a - c)};
    const glm::i64vec3 size = high - low;
    for (const Wide3& e : edges) {
        // The cross products of an edge with x, y and z.
        if (separates({0, e.z, -e.y}, corners, size)) return false;
        if (separates({-e.z, 0, e.x}, corners, size)) return false;
        if (separates({e.y, -e.x, 0}, corners, size)) return false;
    }
    return !separates(cross(edges[0], edges[1]), corners, size);
}

}  // namespace cairn::reference
