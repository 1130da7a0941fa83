#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace cairn::voxelizer {

/// One bit per voxel, 1 = occupied. Rows run along x, in 32-bit words: voxel x is bit x % 32 of word x / 32.
///
///     word index = (z * size.y + y) * words_per_row + x / 32,   words_per_row = ceil(size.x / 32)
///
/// Bits past size.x are 0.
struct BitGrid {
    glm::ivec3 size{0};
    std::vector<std::uint32_t> words;

    BitGrid() = default;
    explicit BitGrid(const glm::ivec3& voxels)
        : size(voxels), words(std::size_t(words_per_row()) * std::size_t(voxels.y) * std::size_t(voxels.z)) {}

    [[nodiscard]] int words_per_row() const { return (size.x + 31) / 32; }
    [[nodiscard]] std::size_t word_index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(words_per_row()) +
               std::size_t(x / 32);
    }
    [[nodiscard]] bool at(const glm::ivec3& v) const {
        return (words[word_index(v.x, v.y, v.z)] >> (v.x % 32) & 1U) != 0;
    }
    void set(const glm::ivec3& v) { words[word_index(v.x, v.y, v.z)] |= 1U << (v.x % 32); }
    [[nodiscard]] std::uint64_t count() const;
    [[nodiscard]] bool operator==(const BitGrid&) const = default;
};

/// The axes along which the levels of a pyramid halve (Forest et al. 2009, section 2.3, Figure 4).
enum class Reduction : std::uint8_t {
    xy,   ///< Figure 4a: all levels keep all slices of z; one look-up reads a column
    xyz,  ///< Figure 4b: the standard octree
};

/// One bit per voxel at every level, each level the OR of the finer one (Forest et al. 2009, section 2.3).
/// Level 0 is the finest. Sizes halve along the axes of the reduction, rounded up, until they are 1 along all
/// of these axes.
class BitmaskPyramid {
public:
    BitmaskPyramid() = default;
    explicit BitmaskPyramid(std::vector<BitGrid> levels) : levels_(std::move(levels)) {}

    [[nodiscard]] int level_count() const { return int(levels_.size()); }
    [[nodiscard]] const BitGrid& level(int i) const { return levels_[std::size_t(i)]; }

private:
    std::vector<BitGrid> levels_;
};

/// Computes a pyramid on the CPU.
[[nodiscard]] BitmaskPyramid build_pyramid(BitGrid finest, Reduction reduction = Reduction::xyz);

/// Size of the next coarser level; the same size if there is none.
[[nodiscard]] glm::ivec3 coarser_size(const glm::ivec3& size, Reduction reduction);

}  // namespace cairn::voxelizer
