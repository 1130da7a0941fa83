#include "voxelizer/write_npy.h"

#include <fmt/format.h>

#include "base/output_file.h"

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

}  // namespace

void write_npy(const BitGrid& bits, const std::filesystem::path& path) {
    OutputFile file(path);
    const std::string text = header(bits.size);
    file.write(text.data(), text.size());
    const glm::ivec3& size = bits.size;
    // Rows of bits run along x, rows of the file along z: 32 slabs at a time read each word once.
    const std::size_t slab_bytes = std::size_t(size.y) * std::size_t(size.z);
    std::vector<std::uint8_t> slabs(slab_bytes * std::size_t(std::min(size.x, 32)));
    for (int x = 0; x < size.x; x += 32) {
        const int count = std::min(size.x - x, 32);
        for (int y = 0; y < size.y; ++y) {
            for (int z = 0; z < size.z; ++z) {
                const std::uint32_t word = bits.words[bits.word_index(x, y, z)];
                std::uint8_t* out = &slabs[std::size_t(y) * std::size_t(size.z) + std::size_t(z)];
                for (int i = 0; i < count; ++i, out += slab_bytes)
                    *out = std::uint8_t(word >> i & 1U);
            }
        }
        file.write(slabs.data(), slab_bytes * std::size_t(count));
    }
    file.commit();
}

}  // namespace cairn::voxelizer
