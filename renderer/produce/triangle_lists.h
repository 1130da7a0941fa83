#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "renderer/pool/tree_shape.h"
#include "voxelizer/surface.h"

namespace cairn::renderer {

/// Which triangles may touch a tile, one voxel of border included: a child filters its parent's list, so that
/// a tile deep in the tree costs what its own triangles cost.
class TriangleLists {
public:
    /// Numbers held before the lists are made anew: 256 MiB. They cost time to remake, never correctness.
    static constexpr std::size_t default_held_limit = std::size_t(64) << 20U;

    /// Keeps a copy of what it needs of the surface: a bounding box a triangle.
    TriangleLists(const TreeShape& shape, const voxelizer::Surface& surface,
                  std::size_t held_limit = default_held_limit);

    struct Box {
        glm::ivec3 low;  ///< lattice units, closed
        glm::ivec3 high;
    };

    /// Global triangle numbers, ascending. Valid until the next call.
    [[nodiscard]] std::span<const std::uint32_t> list(const Tile& tile);
    [[nodiscard]] const Box& box(std::uint32_t triangle) const { return boxes_[triangle]; }

private:
    void split(const Tile& parent, const std::vector<std::uint32_t>& triangles);

    TreeShape shape_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> all_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> lists_;
    std::size_t held_limit_;
    std::size_t held_ = 0;
};

}  // namespace cairn::renderer
