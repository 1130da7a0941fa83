#pragma once

#include <bit>
#include <cstddef>

#include "voxelizer/files/voxel_writer.h"

namespace cairn::voxelizer {

/// The bits of one tile of a grid.
/// @param origin  a multiple of `side`, inside the grid
/// @param side    a multiple of 32
[[nodiscard]] BitGrid tile_bits(const BitGrid& whole, const glm::ivec3& origin, int side = VOXEL_TILE_SIDE);

/// Sets the bits of a tile in a grid.
void put_tile(const VoxelTile& tile, BitGrid& whole);

/// Gives a writer all tiles of a grid that hold voxels, without attributes, in the order of VoxelWriter.
void add_tiles(VoxelWriter& writer, const BitGrid& whole);

/// Calls `visit(voxel, number)` for each occupied voxel. `number` counts up from 0, in the order of
/// VoxelAttributes.
template <typename Visit>
void for_each_voxel(const BitGrid& bits, const Visit& visit) {
    std::size_t number = 0;
    std::size_t word = 0;
    for (int z = 0; z < bits.size.z; ++z) {
        for (int y = 0; y < bits.size.y; ++y) {
            for (int x = 0; x < bits.size.x; x += 32, ++word) {
                for (std::uint32_t left = bits.words[word]; left != 0; left &= left - 1)
                    visit(glm::ivec3(x + std::countr_zero(left), y, z), number++);
            }
        }
    }
}

}  // namespace cairn::voxelizer
