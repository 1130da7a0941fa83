#include "voxelizer/files/voxel_rows.h"

#include <algorithm>

#include "base/error.h"

namespace cairn::voxelizer {
namespace {

/// Word i with bit j becomes word j with bit i, by halves: Warren, Hacker's Delight, section 7-3.
void transpose(std::array<std::uint32_t, 32>& block) {
    std::uint32_t mask = 0x0000FFFF;
    for (unsigned half = 16; half != 0; half >>= 1, mask ^= mask << half) {
        for (unsigned i = 0; i < 32; i = (i + half + 1) & ~half) {
            const std::uint32_t swapped = (block[i] >> half ^ block[i + half]) & mask;
            block[i + half] ^= swapped;
            block[i] ^= swapped << half;
        }
    }
}

}  // namespace

void VoxelRows::gather(const VoxelTile& tile) {
    if (tile.origin.x < slab_)
        throw Error(Fault::internal, "voxel writer", "a tile came after its slab was written");
    const glm::ivec3& size = tile.bits.size;
    const int slice_axis = 3 - row_axis_;
    TurnedTile& turned = tiles_.emplace_back();
    turned.first_word = std::size_t(tile.origin[row_axis_]) / 32;
    turned.slice = tile.origin[slice_axis];
    turned.numbers.assign(blocks_per_side * VOXEL_TILE_SIDE * blocks_per_side, no_block);
    for (int x_block = 0; x_block < tile.bits.words_per_row(); ++x_block) {
        for (int slice = 0; slice < size[slice_axis]; ++slice) {
            for (int low = 0; low < size[row_axis_]; low += 32) {
                glm::ivec3 v(32 * x_block, slice, slice);
                Block block{};
                std::uint32_t any = 0;
                for (int i = 0; i < std::min(32, size[row_axis_] - low); ++i) {
                    v[row_axis_] = low + i;
                    block[std::size_t(i)] = tile.bits.words[tile.bits.word_index(v.x, v.y, v.z)];
                    any |= block[std::size_t(i)];
                }
                if (any == 0) continue;
                transpose(block);
                turned
                    .numbers[(std::size_t(x_block) * VOXEL_TILE_SIDE + std::size_t(slice)) * blocks_per_side +
                             std::size_t(low) / 32] = std::uint16_t(turned.blocks.size());
                turned.blocks.push_back(block);
            }
        }
    }
    turned.blocks.shrink_to_fit();
}

int VoxelRows::begin_slab() {
    std::ranges::sort(tiles_, {}, &TurnedTile::slice);
    return std::min(slab_ + VOXEL_TILE_SIDE, size_.x);
}

bool VoxelRows::fill_row(std::span<const TurnedTile> tiles, int x, int slice) {
    std::ranges::fill(words_, 0U);
    std::uint32_t any = 0;
    for (const TurnedTile& tile : tiles) {
        const std::size_t first =
            (std::size_t(x / 32) * VOXEL_TILE_SIDE + std::size_t(slice)) * blocks_per_side;
        for (std::size_t i = 0; i < blocks_per_side; ++i) {
            const std::uint16_t number = tile.numbers[first + i];
            if (number == no_block) continue;
            const std::uint32_t bits = tile.blocks[number][std::size_t(x % 32)];
            words_[tile.first_word + i] = bits;
            any |= bits;
        }
    }
    return any != 0;
}

}  // namespace cairn::voxelizer
