#pragma once

#include <cstddef>

#include "renderer/pool/tree_shape.h"
#include "voxelizer/triangle_index.h"

namespace cairn::renderer {

/// Numbers that the lists of tiles may hold: 256 MiB.
constexpr std::size_t tile_list_limit = std::size_t(64) << 20U;

/// The index whose cells are the tiles of a tree, each list with what touches one voxel of border: of the
/// coarsest mip.
[[nodiscard]] inline voxelizer::TriangleIndex tile_lists(const TreeShape& shape,
                                                         const voxelizer::Surface& surface,
                                                         std::size_t held_limit = tile_list_limit) {
    return voxelizer::TriangleIndex(surface, {.level_step = shape.n_shift(),
                                              .border_shift = shape.m_shift() - shape.mips,
                                              .held_limit = held_limit});
}

[[nodiscard]] inline voxelizer::Cell cell_of(const Tile& tile, const TreeShape& shape) {
    return {shape.n_shift() * tile.level, glm::ivec3(tile.position)};
}

}  // namespace cairn::renderer
