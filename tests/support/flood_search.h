#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"

namespace cairn::test {

template <typename Visit>
void for_each_voxel(const glm::ivec3& size, const Visit& visit) {
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x)
                visit(glm::ivec3(x, y, z));
        }
    }
}

/// The free voxels that a search finds, one voxel after the other, from all sides of a grid.
inline voxelizer::BitGrid searched(const voxelizer::BitGrid& surface) {
    voxelizer::BitGrid found(surface.size);
    std::vector<glm::ivec3> waiting;
    const auto visit = [&](const glm::ivec3& v) {
        if (surface.at(v) || found.at(v)) return;
        found.set(v);
        waiting.push_back(v);
    };
    for_each_voxel(surface.size, [&](const glm::ivec3& v) {
        if (glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, surface.size - 1))) visit(v);
    });
    while (!waiting.empty()) {
        const glm::ivec3 v = waiting.back();
        waiting.pop_back();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 beside = v;
                beside[axis] += step;
                if (beside[axis] >= 0 && beside[axis] < surface.size[axis]) visit(beside);
            }
        }
    }
    return found;
}

}  // namespace cairn::test
