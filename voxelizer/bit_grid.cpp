#include "voxelizer/bit_grid.h"

#include <bit>

namespace cairn::voxelizer {
namespace {

/// Bit i of the result is the OR of bits 2i and 2i + 1.
std::uint32_t or_of_pairs(std::uint32_t word) {
    word = (word | word >> 1) & 0x55555555U;
    word = (word | word >> 1) & 0x33333333U;
    word = (word | word >> 2) & 0x0f0f0f0fU;
    word = (word | word >> 4) & 0x00ff00ffU;
    return (word | word >> 8) & 0x0000ffffU;
}

BitGrid half(const BitGrid& fine, Reduction reduction) {
    BitGrid coarse(coarser_size(fine.size, reduction));
    const int z_step = reduction == Reduction::xyz ? 2 : 1;
    const int fine_words = fine.words_per_row();
    for (int z = 0; z < fine.size.z; ++z) {
        for (int y = 0; y < fine.size.y; ++y) {
            const std::uint32_t* const in = &fine.words[fine.word_index(0, y, z)];
            std::uint32_t* const out = &coarse.words[coarse.word_index(0, y / 2, z / z_step)];
            for (int w = 0; w < fine_words; ++w)
                out[w / 2] |= or_of_pairs(in[w]) << (w % 2 * 16);
        }
    }
    return coarse;
}

}  // namespace

std::uint64_t BitGrid::count() const {
    std::uint64_t sum = 0;
    for (const std::uint32_t word : words)
        sum += std::uint64_t(std::popcount(word));
    return sum;
}

glm::ivec3 coarser_size(const glm::ivec3& size, Reduction reduction) {
    const glm::ivec3 half_size = (size + 1) / 2;
    return {half_size.x, half_size.y, reduction == Reduction::xyz ? half_size.z : size.z};
}

BitmaskPyramid build_pyramid(BitGrid finest, Reduction reduction) {
    std::vector<BitGrid> levels;
    levels.push_back(std::move(finest));
    while (coarser_size(levels.back().size, reduction) != levels.back().size) {
        levels.push_back(half(levels.back(), reduction));
    }
    return BitmaskPyramid(std::move(levels));
}

}  // namespace cairn::voxelizer
