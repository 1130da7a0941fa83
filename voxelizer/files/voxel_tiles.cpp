#include "voxelizer/files/voxel_tiles.h"

#include <algorithm>

namespace cairn::voxelizer {

BitGrid tile_bits(const BitGrid& whole, const glm::ivec3& origin, int side) {
    BitGrid tile(glm::min(whole.size - origin, glm::ivec3(side)));
    for (int z = 0; z < tile.size.z; ++z) {
        for (int y = 0; y < tile.size.y; ++y) {
            const std::size_t from = whole.word_index(origin.x, origin.y + y, origin.z + z);
            std::copy_n(whole.words.begin() + std::ptrdiff_t(from), tile.words_per_row(),
                        tile.words.begin() + std::ptrdiff_t(tile.word_index(0, y, z)));
        }
    }
    return tile;
}

void put_tile(const VoxelTile& tile, BitGrid& whole) {
    const int words = tile.bits.words_per_row();
    for (int z = 0; z < tile.bits.size.z; ++z) {
        for (int y = 0; y < tile.bits.size.y; ++y) {
            const std::size_t from = tile.bits.word_index(0, y, z);
            const std::size_t to = whole.word_index(tile.origin.x, tile.origin.y + y, tile.origin.z + z);
            for (std::size_t word = 0; word < std::size_t(words); ++word)
                whole.words[to + word] |= tile.bits.words[from + word];
        }
    }
}

void add_tiles(VoxelWriter& writer, const BitGrid& whole) {
    for (int x = 0; x < whole.size.x; x += VOXEL_TILE_SIDE) {
        for (int z = 0; z < whole.size.z; z += VOXEL_TILE_SIDE) {
            for (int y = 0; y < whole.size.y; y += VOXEL_TILE_SIDE) {
                const VoxelTile tile{{x, y, z}, tile_bits(whole, {x, y, z}), {}};
                if (std::ranges::any_of(tile.bits.words, [](std::uint32_t word) { return word != 0; }))
                    writer.add(tile);
            }
        }
    }
}

}  // namespace cairn::voxelizer
