#include "voxelizer/write_npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "voxelizer/voxel_tiles.h"

namespace cairn::voxelizer {
namespace {

/// Magic, version, length of the dictionary, dictionary; padded so that the data starts at a multiple of 64.
std::string header(const glm::ivec3& size) {
    std::string dictionary = fmt::format(
        "{{'descr': '|u1', 'fortran_order': False, 'shape': ({}, {}, {}), }}", size.x, size.y, size.z);
    constexpr std::size_t prefix = 10;
    const std::size_t total = (prefix + dictionary.size() + 1 + 63) / 64 * 64;
    dictionary.resize(total - prefix - 1, ' ');
    dictionary += '\n';
    std::string text("\x93NUMPY\x01\x00", 8);
    text += char(dictionary.size() & 0xFFU);
    text += char(dictionary.size() >> 8);
    return text + dictionary;
}

/// Rows of bits run along x, rows of the file along z: 32 x 32 voxels of one y, word i with bit j, become
/// word j with bit i. By halves: Warren, Hacker's Delight, section 7-3.
using Block = std::array<std::uint32_t, 32>;
void transpose(Block& block) {
    std::uint32_t mask = 0x0000FFFF;
    for (unsigned half = 16; half != 0; half >>= 1, mask ^= mask << half) {
        for (unsigned i = 0; i < 32; i = (i + half + 1) & ~half) {
            const std::uint32_t swapped = (block[i] >> half ^ block[i + half]) & mask;
            block[i + half] ^= swapped;
            block[i] ^= swapped << half;
        }
    }
}

/// Eight bits as eight bytes, the lowest first in memory.
const std::array<std::array<std::uint8_t, 8>, 256> bytes_of_bits = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (unsigned bits = 0; bits < 256; ++bits)
        for (unsigned i = 0; i < 8; ++i)
            table[bits][i] = std::uint8_t(bits >> i & 1U);
    return table;
}();

constexpr int blocks_a_side = VOXEL_TILE_SIDE / 32;
constexpr std::uint16_t no_block = 0xFFFF;

/// A tile with its rows along z; only blocks that are not empty are kept.
struct TurnedTile {
    explicit TurnedTile(const VoxelTile& tile);
    [[nodiscard]] std::uint16_t number_of(int x_block, int y, int z_block) const {
        return numbers[std::size_t((x_block * VOXEL_TILE_SIDE + y) * blocks_a_side + z_block)];
    }

    glm::ivec3 origin;
    glm::ivec3 size;
    std::vector<std::uint16_t> numbers;
    std::vector<Block> blocks;
};

TurnedTile::TurnedTile(const VoxelTile& tile)
    : origin(tile.origin),
      size(tile.bits.size),
      numbers(std::size_t(blocks_a_side * VOXEL_TILE_SIDE * blocks_a_side), no_block) {
    for (int x_block = 0; x_block < tile.bits.words_per_row(); ++x_block) {
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; z += 32) {
                Block block{};
                std::uint32_t any = 0;
                for (int i = 0; i < std::min(32, size.z - z); ++i) {
                    block[std::size_t(i)] = tile.bits.words[tile.bits.word_index(32 * x_block, y, z + i)];
                    any |= block[std::size_t(i)];
                }
                if (any == 0) continue;
                transpose(block);
                numbers[std::size_t((x_block * VOXEL_TILE_SIDE + y) * blocks_a_side + z / 32)] =
                    std::uint16_t(blocks.size());
                blocks.push_back(block);
            }
        }
    }
    blocks.shrink_to_fit();
}

class NpyWriter final : public VoxelWriter {
public:
    NpyWriter(const std::filesystem::path& path, const glm::ivec3& size) : file_(path), size_(size) {
        const std::string text = header(size);
        file_.write(text.data(), text.size());
    }

    void add(const VoxelTile& tile) override {
        if (tile.origin.x < slab_)
            throw Error(Fault::internal, "npy writer", "a tile came after its slab was written");
        while (slab_ < tile.origin.x)
            write_slab();
        tiles_.emplace_back(tile);
    }

    void finish() override {
        while (slab_ < size_.x)
            write_slab();
        file_.commit();
    }

private:
    void write_slab();
    void write_band(int x, std::span<const TurnedTile> tiles);

    OutputFile file_;
    glm::ivec3 size_;
    int slab_ = 0;  ///< x of the slab that is gathered
    std::vector<TurnedTile> tiles_;
    std::vector<std::uint8_t> band_;  ///< of one x: rows of as many y as a tile has
};

void NpyWriter::write_slab() {
    std::ranges::sort(tiles_, {}, [](const TurnedTile& t) { return std::pair(t.origin.y, t.origin.z); });
    const int end = std::min(slab_ + VOXEL_TILE_SIDE, size_.x);
    for (int x = slab_; x < end; ++x) {
        auto tile = tiles_.begin();
        for (int y = 0; y < size_.y; y += VOXEL_TILE_SIDE) {
            const auto first = tile;
            while (tile != tiles_.end() && tile->origin.y == y)
                ++tile;
            band_.resize(std::size_t(std::min(VOXEL_TILE_SIDE, size_.y - y)) * std::size_t(size_.z));
            if (first == tile)
                file_.write_zeros(band_.size());
            else
                write_band(x - slab_, {first, tile});
        }
    }
    tiles_.clear();
    slab_ = end;
}

void NpyWriter::write_band(int x, std::span<const TurnedTile> tiles) {
    std::ranges::fill(band_, std::uint8_t(0));
    bool any = false;
    for (const TurnedTile& tile : tiles) {
        for (int y = 0; y < tile.size.y; ++y) {
            for (int z = 0; z < tile.size.z; z += 32) {
                const std::uint16_t number = tile.number_of(x / 32, y, z / 32);
                if (number == no_block) continue;
                const std::uint32_t bits = tile.blocks[number][std::size_t(x % 32)];
                if (bits == 0) continue;
                any = true;
                std::array<std::array<std::uint8_t, 8>, 4> bytes;
                for (std::size_t i = 0; i < 4; ++i)
                    bytes[i] = bytes_of_bits[bits >> 8 * i & 0xFFU];
                std::uint8_t* const row = &band_[std::size_t(y) * std::size_t(size_.z)];
                std::memcpy(row + tile.origin.z + z, bytes.data(),
                            std::size_t(std::min(32, tile.size.z - z)));
            }
        }
    }
    if (any)
        file_.write(band_.data(), band_.size());
    else
        file_.write_zeros(band_.size());
}

}  // namespace

std::unique_ptr<VoxelWriter> make_npy_writer(const std::filesystem::path& path, const Grid& grid) {
    return std::make_unique<NpyWriter>(path, grid.resolution);
}

void write_npy(const BitGrid& bits, const std::filesystem::path& path) {
    NpyWriter writer(path, bits.size);
    add_tiles(writer, bits);
    writer.finish();
}

}  // namespace cairn::voxelizer
