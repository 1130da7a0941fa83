#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#include "shaders/interop/grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/solid/solid_triangles.h"
#include "voxelizer/surface/crossed_rows.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// The corners of a triangle, in lattice units.
using LatticeCorners = std::array<glm::i64vec3, 3>;

/// Whether all corners lie where the products of their coordinates fit in 64 bits, as in the shaders.
inline bool in_shader_range(const LatticeCorners& p) {
    constexpr std::int64_t side = std::int64_t(1) << LATTICE_BITS;
    return std::all_of(p.begin(), p.end(), [](const glm::i64vec3& corner) {
        return glm::all(glm::greaterThanEqual(corner, glm::i64vec3(-side))) &&
               glm::all(glm::lessThanEqual(corner, glm::i64vec3(2 * side)));
    });
}

template <typename Int, typename Visit>
void visit_rows(const LatticeCorners& p, const Region& region, int axis, const Visit& visit) {
    std::array<std::array<Int, 3>, 3> corners;
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = {Int(p[i].x), Int(p[i].y), Int(p[i].z)};
    const CrossedRows<Int> rows(corners, region, axis);
    if (rows.winding() == 0) return;
    for (int v = rows.first_v(); v <= rows.last_v(); ++v) {
        const auto interval = rows.crossed_u(v);
        for (int u = interval.first; u <= interval.last; ++u)
            visit(u, v, rows);
    }
}

inline bool every_triangle(const LatticeCorners& /*corners*/) {
    return true;
}

/// Calls visit(u, v, rows), in parallel, for each row of a region along an axis and each triangle of a solid
/// fill that crosses it; `rows` is the triangle's CrossedRows. Triangles of which wanted(corners) says no are
/// left out.
template <typename Wanted, typename Visit>
void visit_crossings(const Surface& surface, const Region& region, int axis, const Wanted& wanted,
                     const Visit& visit) {
    for_each_triangle(surface, [&](const LatticeCorners& corners) {
        if (!wanted(corners)) return;
        if (in_shader_range(corners)) {
            visit_rows<std::int64_t>(corners, region, axis, visit);
        } else {
            visit_rows<Int128>(corners, region, axis, visit);
        }
    });
}

}  // namespace cairn::voxelizer
