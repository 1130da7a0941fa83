#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>
#include <tbb/parallel_for.h>

#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Calls add(corners), in parallel, for every triangle that takes part in a solid fill: all triangles but
/// those that an alpha mask cuts.
template <typename Add>
void for_each_triangle(const Surface& surface, const Add& add) {
    const auto is_cut = [&surface](std::uint32_t material) {
        return (surface.materials[material].flags >> MATERIAL_MASK_BIT & 1U) != 0;
    };
    for (const SurfaceChunk& chunk : surface.chunks) {
        tbb::parallel_for(std::size_t(0), chunk.triangles.size(), [&](std::size_t i) {
            const glm::uvec3& numbers = chunk.triangles[i].vertices;
            if (is_cut(chunk.triangles[i].material)) return;
            std::array<glm::i64vec3, 3> corners;
            for (int corner = 0; corner < 3; ++corner) {
                const auto& p = chunk.positions[numbers[corner]];
                corners[std::size_t(corner)] = {p[0], p[1], p[2]};
            }
            add(corners);
        });
    }
    tbb::parallel_for(std::size_t(0), surface.far_triangles.size(), [&](std::size_t i) {
        const FarTriangle& triangle = surface.far_triangles[i];
        if (!is_cut(triangle.material)) add(triangle.positions);
    });
    tbb::parallel_for(std::size_t(0), surface.outside_triangles.size(),
                      [&](std::size_t i) { add(surface.outside_triangles[i]); });
}

}  // namespace cairn::voxelizer
