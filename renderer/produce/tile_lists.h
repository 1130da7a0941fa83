#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/pool/tree_shape.h"
#include "shaders/interop/grid.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::renderer {

/// Triangle numbers that the lists of tiles may hold together: 256 MiB.
constexpr std::size_t tile_list_limit = std::size_t(64) << 20U;

/// Levels from a cell that has a list to the next one that has. If n is a power of two, cells are the tiles
/// of a tree.
[[nodiscard]] inline int tile_list_step(const TreeShape& shape) {
    return shape.cell_base() == 2 ? shape.n_shift() : 2;
}

/// The index whose cells are the tiles of a tree. The list of a cell includes what touches its border, one
/// voxel of the coarsest mip wide. With n = 3, whose tiles are no cells, lists have no border.
[[nodiscard]] inline voxelizer::TriangleIndex tile_lists(const TreeShape& shape,
                                                         const voxelizer::Surface& surface,
                                                         std::size_t held_limit = tile_list_limit) {
    voxelizer::TriangleIndexOptions options;
    options.level_step = tile_list_step(shape);
    options.held_limit = held_limit;
    if (shape.cell_base() == 2) options.border_shift = shape.m_shift() - shape.mips;
    return voxelizer::TriangleIndex(surface, options);
}

[[nodiscard]] inline voxelizer::Cell cell_of(const Tile& tile, const TreeShape& shape) {
    return {shape.n_shift() * tile.level, glm::ivec3(tile.position)};
}

/// Triangles that may touch a tile or its border: global numbers, ascending.
/// @param out  filled with the numbers if no list of the index holds just these triangles.
/// @return     valid until the next call, and for as long as `out` is.
[[nodiscard]] inline std::span<const std::uint32_t> triangles_of(const Tile& tile, const TreeShape& shape,
                                                                 voxelizer::TriangleIndex& lists,
                                                                 std::vector<std::uint32_t>& out) {
    if (shape.cell_base() == 2) return lists.list(cell_of(tile, shape));
    // The side of the finest voxels is the largest power of two of lattice units that divides all tiles'
    // sides.
    const int finest = shape.voxel_side(shape.max_level);
    const int voxel = shape.voxel_side(tile.level) / finest;
    const glm::ivec3 low = (glm::ivec3(tile.position) * shape.m - 1) * voxel;
    out = lists.triangles_in(
        {LATTICE_BITS - int(std::bit_width(unsigned(finest))) + 1, low, glm::ivec3((shape.m + 2) * voxel)});
    return out;
}

}  // namespace cairn::renderer
