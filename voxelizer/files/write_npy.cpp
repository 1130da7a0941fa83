#include "voxelizer/files/write_npy.h"

#include <array>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "base/output_file.h"
#include "voxelizer/files/voxel_rows.h"
#include "voxelizer/files/voxel_tiles.h"

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

/// Eight bits as eight bytes, the lowest first in memory.
const std::array<std::array<std::uint8_t, 8>, 256> bytes_of_bits = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (unsigned bits = 0; bits < 256; ++bits)
        for (unsigned i = 0; i < 8; ++i)
            table[bits][i] = std::uint8_t(bits >> i & 1U);
    return table;
}();

class NpyWriter final : public VoxelWriter {
public:
    NpyWriter(const std::filesystem::path& path, const glm::ivec3& size)
        : file_(path),
          rows_(size, 2),
          bytes_((std::size_t(size.z) + 31) / 32 * 32),
          row_bytes_(std::size_t(size.z)) {
        const std::string text = header(size);
        file_.write(text.data(), text.size());
    }

    void add(const VoxelTile& tile) override { rows_.add(tile, *this); }
    void finish() override {
        rows_.finish(*this);
        file_.commit();
    }

    void empty_rows(std::uint64_t count) { file_.write_zeros(count * row_bytes_); }
    void row(std::span<const std::uint32_t> words) {
        for (std::size_t i = 0; i < words.size(); ++i) {
            for (std::size_t byte = 0; byte < 4; ++byte)
                std::memcpy(&bytes_[32 * i + 8 * byte], bytes_of_bits[words[i] >> 8 * byte & 0xFFU].data(),
                            8);
        }
        file_.write(bytes_.data(), row_bytes_);
    }

private:
    OutputFile file_;
    VoxelRows rows_;
    std::vector<std::uint8_t> bytes_;
    std::size_t row_bytes_;
};

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
