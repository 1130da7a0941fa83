#include "renderer/produce/triangle_lists.h"

#include <algorithm>

namespace cairn::renderer {
namespace {

/// What the map and the vector around a list take, in numbers.
constexpr std::size_t entry_cost = 24;

}  // namespace

TriangleLists::TriangleLists(const TreeShape& shape, const voxelizer::Surface& surface,
                             std::size_t held_limit)
    : shape_(shape), held_limit_(held_limit) {
    boxes_.reserve(surface.triangle_count);
    all_.reserve(surface.triangle_count);
    std::uint32_t chunk_first = 0;
    for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
        // Numbers leave a gap after a chunk that is not full; boxes_ has it too.
        boxes_.resize(chunk_first, Box{glm::ivec3(1), glm::ivec3(0)});
        auto corner = [&](std::uint32_t v) {
            const auto& p = chunk.positions[v];
            return glm::ivec3(p[0], p[1], p[2]);
        };
        for (const interop::SurfaceTriangle& triangle : chunk.triangles) {
            const glm::ivec3 a = corner(triangle.vertices_material.x);
            const glm::ivec3 b = corner(triangle.vertices_material.y);
            const glm::ivec3 c = corner(triangle.vertices_material.z);
            all_.push_back(std::uint32_t(boxes_.size()));
            boxes_.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        chunk_first += SURFACE_CHUNK_TRIANGLES;
    }
}

std::span<const std::uint32_t> TriangleLists::list(const Tile& tile) {
    if (tile.level == 0) return all_;
    if (const auto found = lists_.find(key_of(tile)); found != lists_.end()) return found->second;
    if (held_ > held_limit_) {
        lists_.clear();
        held_ = 0;
    }
    const Tile parent = parent_of(tile, shape_.n);
    const std::span<const std::uint32_t> from = list(parent);
    split(parent, {from.begin(), from.end()});
    return lists_[key_of(tile)];
}

void TriangleLists::split(const Tile& parent, const std::vector<std::uint32_t>& triangles) {
    std::vector<std::vector<std::uint32_t>> children(std::size_t(shape_.child_count()));
    const int n = shape_.n;
    const int child_shift = LATTICE_BITS - shape_.n_shift() * (parent.level + 1);
    const int border = 1 << (LATTICE_BITS - shape_.voxel_level(parent.level + 1));
    const glm::ivec3 low = parent.position << (child_shift + shape_.n_shift());
    for (const std::uint32_t triangle : triangles) {
        // Child c is touched when [c side - border, (c + 1) side + border] meets the box; all closed.
        const Box& box = boxes_[triangle];
        const glm::ivec3 last = (box.high - low + border) >> child_shift;
        const glm::ivec3 first = -((-(box.low - low - border)) >> child_shift) - 1;
        const glm::ivec3 from = glm::max(first, glm::ivec3(0));
        const glm::ivec3 to = glm::min(last, glm::ivec3(n - 1));
        for (int z = from.z; z <= to.z; ++z) {
            for (int y = from.y; y <= to.y; ++y) {
                for (int x = from.x; x <= to.x; ++x) {
                    const int child = x + n * (y + n * z);
                    children[std::size_t(child)].push_back(triangle);
                }
            }
        }
    }
    for (int child = 0; child < shape_.child_count(); ++child) {
        std::vector<std::uint32_t>& list = children[std::size_t(child)];
        if (list.empty()) continue;
        held_ += list.size() + entry_cost;
        list.shrink_to_fit();
        lists_[key_of(child_of(parent, n, child))] = std::move(list);
    }
}

}  // namespace cairn::renderer
