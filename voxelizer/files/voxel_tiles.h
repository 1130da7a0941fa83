#pragma once

#include <bit>
#include <cstddef>

#include "voxelizer/files/voxel_writer.h"

namespace cairn::voxelizer {

/// The part of a whole that is one tile. @param origin  a multiple of `side`, inside; that is one of 32.
[[nodiscard]] BitGrid tile_bits(const BitGrid& whole, const glm::ivec3& origin, int side = VOXEL_TILE_SIDE);

/// Sets the bits of a tile in a whole.
void put_tile(const VoxelTile& tile, BitGrid& whole);

/// Gives a writer all tiles of a whole that hold voxels, without attributes, in the order that it wants.
void add_tiles(VoxelWriter& writer, const BitGrid& whole);

/// Calls `visit(voxel, number)` for each occupied voxel in the order of VoxelAttributes; the number counts
/// them.
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
