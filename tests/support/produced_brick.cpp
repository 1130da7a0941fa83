#include "tests/support/produced_brick.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "renderer/produce/tile_lists.h"
#include "shaders/interop/pool.h"

namespace cairn::test {
namespace {

using renderer::BrickPool;

GLuint bound_texture(const BrickPool& pool, unsigned unit, GLenum kind) {
    pool.bind_for_reading();
    glActiveTexture(GL_TEXTURE0 + unit);
    GLint id = 0;
    glGetIntegerv(kind, &id);
    return GLuint(id);
}

GLuint mask_buffer(const BrickPool& pool) {
    GLint id = 0;
    glGetTextureLevelParameteriv(bound_texture(pool, TEXTURE_BRICK_MASKS, GL_TEXTURE_BINDING_BUFFER), 0,
                                 GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &id);
    return GLuint(id);
}

int block_side(int m) {
    return m % 3 == 0 ? 3 : 4;
}

int mask_words(int m) {
    const int across = m / block_side(m);
    const int blocks = across * across * across;
    return blocks + (blocks + 63) / 64;
}

std::vector<std::uint32_t> read_texels(GLuint texture, const glm::ivec3& low, int side, GLenum format,
                                       GLenum type) {
    std::vector<std::uint32_t> texels(std::size_t(side) * std::size_t(side) * std::size_t(side));
    glGetTextureSubImage(texture, 0, low.x, low.y, low.z, side, side, side, format, type,
                         GLsizei(texels.size() * sizeof(texels[0])), texels.data());
    return texels;
}

glm::ivec3 size_of(GLuint texture) {
    glm::ivec3 size;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &size.x);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &size.y);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_DEPTH, &size.z);
    return size;
}

std::size_t volume(const glm::ivec3& size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

template <typename Occupied>
voxelizer::BitGrid bits_where(int low, int side, const Occupied& occupied) {
    voxelizer::BitGrid bits{glm::ivec3(side)};
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                if (occupied(glm::ivec3(x, y, z) + low)) bits.set({x, y, z});
            }
        }
    }
    return bits;
}

glm::vec3 from_octahedral(const glm::vec2& e) {
    const float z = 1.0F - std::abs(e.x) - std::abs(e.y);
    const glm::vec2 folded =
        (1.0F - glm::abs(glm::vec2(e.y, e.x))) * glm::vec2(e.x < 0 ? -1 : 1, e.y < 0 ? -1 : 1);
    return glm::normalize(glm::vec3(z < 0.0F ? folded : e, z));
}

}  // namespace

std::optional<ProducedSlab> slab_of(std::uint32_t normal) {
    if ((normal & 0x3FFFFU) == 0 || normal >> 30U != 0) return std::nullopt;
    const glm::vec3 unit = from_octahedral((glm::vec2(normal & 511U, normal >> 9U & 511U) - 256.0F) / 255.0F);
    const glm::dvec3 n(unit);
    const double corners = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);  // from the first to the last
    return ProducedSlab{n, corners * (double(normal >> 18U & 63U) / 64.0 - 0.5),
                        corners * (double((normal >> 24U & 63U) + 1) / 64.0 - 0.5)};
}

double ProducedSlab::coverage() const {
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double reach = 0.5 * size[axis] + 0.125 * (size[u] + size[v]);
    int columns = 0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const double middle = 0.25 * ((i - 1.5) * normal[u] + (j - 1.5) * normal[v]);
            columns += middle + reach > low && middle - reach < high ? 1 : 0;
        }
    }
    return columns / 16.0;
}

glm::ivec4 ProducedBrick::color_at(const glm::ivec3& place) const {
    const std::uint32_t texel = color[index(place)];
    return {texel & 255U, texel >> 8U & 255U, texel >> 16U & 255U, texel >> 24U};
}

glm::vec3 ProducedBrick::normal_at(const glm::ivec3& place) const {
    const std::uint32_t texel = normal[index(place)];
    if (texel == 0) return glm::vec3(0.0F);
    return from_octahedral((glm::vec2(texel & 511U, texel >> 9U & 511U) - 256.0F) / 255.0F);
}

glm::vec3 ProducedBrick::second_normal_at(const glm::ivec3& place) const {
    const std::uint32_t texel = normal[index(place)];
    return from_octahedral((glm::vec2(texel >> 18U & 63U, texel >> 24U & 63U) - 31.0F) / 31.0F);
}

float ProducedBrick::second_share_at(const glm::ivec3& place) const {
    return float(normal[index(place)] >> 30U) / 6.0F;
}

bool ProducedBrick::occupied(const glm::ivec3& place) const {
    const int side = block_side(m);
    const glm::ivec3 block = place / side;
    const glm::ivec3 voxel = place % side;
    const int blocks = m / side;
    const std::size_t summaries = std::size_t((blocks * blocks * blocks + 63) / 64);
    const std::uint64_t word =
        masks[summaries + std::size_t(block.x + blocks * (block.y + blocks * block.z))];
    return (word >> unsigned(voxel.x + side * (voxel.y + side * voxel.z)) & 1U) != 0;
}

bool ProducedBrick::summary_at(const glm::ivec3& block) const {
    const int across = m / block_side(m);
    const auto bit = unsigned(block.x + across * (block.y + across * block.z));
    return (masks[bit / 64] >> (bit % 64) & 1U) != 0;
}

namespace {

/// A packed brick, decoded without the shaders' functions.
class PackedBrick {
public:
    PackedBrick(const BrickPool& pool, const renderer::TreeShape& shape, int slot)
        : shape_(shape), has_color_(pool.has_color()) {
        const renderer::PackedBricks::Run run = pool.packed()->run(slot);
        words_ = pool.packed()->words().read_all<std::uint32_t>(run.words, std::size_t(run.first) * 4);
    }

    [[nodiscard]] std::uint64_t mask(int word) const {
        const std::size_t at = 2 * std::size_t(word);
        return words_[at] | std::uint64_t(words_[at + 1]) << 32U;
    }

    struct Voxel {
        bool occupied = false;
        std::uint32_t normal = 0;
        std::uint32_t color = 0;  ///< RGBA8; without colours, coverage in the highest byte
        std::optional<std::uint64_t> marks;
    };
    [[nodiscard]] Voxel voxel(int mip, const glm::ivec3& place) const {
        const auto [group, bit] = bit_of(mip, place);
        const std::uint64_t occupied = mask(shape_.summary_words() + group);
        if ((occupied >> unsigned(bit) & 1U) == 0) return {};
        const int ranks = 2 * (shape_.summary_words() + shape_.groups());
        const std::size_t record =
            words_[std::size_t(ranks + group)] +
            std::size_t(std::popcount(occupied & ((std::uint64_t(1) << unsigned(bit)) - 1)));
        const std::size_t at = std::size_t(shape_.head_words()) + record * (has_color_ ? 2 : 1);
        Voxel found{true, words_.at(at), has_color_ ? words_.at(at + 1) : 0, std::nullopt};
        if (has_color_ && group >= shape_.inner_groups()) return found;
        const std::size_t entry = words_[std::size_t(ranks + shape_.groups())] + 2 * (record / 32);
        const std::uint32_t kept = words_.at(entry);
        const std::uint32_t own = std::uint32_t(1) << (record % 32);
        if ((kept & own) != 0) {
            const std::size_t marks = words_.at(entry + 1) + 2 * std::size_t(std::popcount(kept & (own - 1)));
            found.marks = words_.at(marks) | std::uint64_t(words_.at(marks + 1)) << 32U;
        }
        if (!has_color_) {
            const double covered = found.marks ? coverage(*found.marks) : slab_of(found.normal)->coverage();
            found.color = std::uint32_t(std::lround(covered * 255.0)) << 24U;
        }
        return found;
    }

private:
    /// The greatest share of the 4^2 rows along an axis that have a mark.
    static double coverage(std::uint64_t marks) {
        int most = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<bool, 16> rows{};
            for (int i = 0; i < 64; ++i) {
                const std::array<int, 3> p = {i % 4, i / 4 % 4, i / 16};
                if ((marks >> unsigned(i) & 1U) != 0)
                    rows[std::size_t(p[std::size_t((axis + 1) % 3)] + 4 * p[std::size_t((axis + 2) % 3)])] =
                        true;
            }
            most = std::max(most, int(std::ranges::count(rows, true)));
        }
        return most / 16.0;
    }
    /// Group and bit: the border's voxels are counted in order of their places.
    [[nodiscard]] std::pair<int, int> bit_of(int mip, const glm::ivec3& place) const {
        const int m = shape_.m >> mip;
        int first = 0;
        const bool in_border = glm::any(glm::lessThan(place, glm::ivec3(0))) ||
                               glm::any(glm::greaterThanEqual(place, glm::ivec3(m)));
        if (!in_border) {
            for (int k = 0; k < mip; ++k)
                first += shape_.blocks(k);
            const int side = shape_.block_side();
            const int across = std::max(m / side, 1);
            const glm::ivec3 block = place / side;
            const glm::ivec3 bit = place % side;
            return {first + block.x + across * (block.y + across * block.z),
                    bit.x + side * (bit.y + side * bit.z)};
        }
        first = shape_.inner_groups();
        for (int k = 0; k < mip; ++k)
            first += (shape_.border_voxels(k) + 63) / 64;
        if (border_numbers_[std::size_t(mip)].empty()) number_border(mip);
        const int number = border_numbers_[std::size_t(mip)].at(
            std::size_t(place.x + 1 + (m + 2) * (place.y + 1 + (m + 2) * (place.z + 1))));
        return {first + number / 64, number % 64};
    }
    /// Numbers the border as packed_brick.glsl says: whole layers below and above, then whole rows before and
    /// behind, layer by layer, then the rest.
    void number_border(int mip) const {
        const int m = shape_.m >> mip;
        const auto at_end = [m](int p) { return p < 0 || p == m; };
        std::vector<int>& numbers = border_numbers_[std::size_t(mip)];
        numbers.assign(std::size_t(m + 2) * std::size_t(m + 2) * std::size_t(m + 2), -1);
        int next = 0;
        const auto number = [&](int x, int y, int z) {
            numbers[std::size_t(x + 1 + (m + 2) * (y + 1 + (m + 2) * (z + 1)))] = next++;
        };
        for (const int z : {-1, m})
            for (int y = -1; y <= m; ++y)
                for (int x = -1; x <= m; ++x)
                    number(x, y, z);
        for (int z = 0; z < m; ++z)
            for (const int y : {-1, m})
                for (int x = -1; x <= m; ++x)
                    number(x, y, z);
        for (int z = 0; z < m; ++z)
            for (int y = 0; y < m; ++y)
                for (int x = -1; x <= m; ++x)
                    if (at_end(x)) number(x, y, z);
    }

    renderer::TreeShape shape_;
    bool has_color_;
    std::vector<std::uint32_t> words_;
    mutable std::array<std::vector<int>, 4> border_numbers_;
};

ProducedMip read_packed_mip(const BrickPool& pool, const renderer::TreeShape& shape, int slot, int mip) {
    ProducedMip out;
    out.side = shape.mip_side(mip);
    if (pool.packed()->run(slot).words == 0) {  // empty
        const std::size_t voxels = volume(glm::ivec3(out.side));
        out.color.assign(voxels, 0);
        out.normal.assign(voxels, 0);
        out.marks.assign(voxels, std::nullopt);
        out.occupied.assign(volume(glm::ivec3(out.side - 2)), false);
        return out;
    }
    const PackedBrick brick(pool, shape, slot);
    const int m = out.side - 2;
    for (int i = 0; i < out.side * out.side * out.side; ++i) {
        const glm::ivec3 place =
            glm::ivec3(i % out.side, i / out.side % out.side, i / (out.side * out.side)) - 1;
        const PackedBrick::Voxel voxel = brick.voxel(mip, place);
        out.color.push_back(voxel.color);
        out.normal.push_back(voxel.normal);
        out.marks.push_back(voxel.marks);
        if (glm::all(glm::greaterThanEqual(place, glm::ivec3(0))) &&
            glm::all(glm::lessThan(place, glm::ivec3(m))))
            out.occupied.push_back(voxel.occupied);
    }
    return out;
}

ProducedBrick read_packed_brick(const BrickPool& pool, const renderer::TreeShape& shape, int slot) {
    ProducedMip finest = read_packed_mip(pool, shape, slot, 0);
    ProducedBrick brick{shape.m, std::move(finest.color), std::move(finest.normal), {}};
    const PackedBrick packed(pool, shape, slot);
    for (int word = 0; word < shape.mask_words(); ++word)
        brick.masks.push_back(packed.mask(word));
    return brick;
}

ProducedBrick empty_brick(const renderer::TreeShape& shape) {
    const std::size_t voxels = volume(glm::ivec3(shape.m + 2));
    return {shape.m, std::vector<std::uint32_t>(voxels, 0), std::vector<std::uint32_t>(voxels, 0),
            std::vector<std::uint64_t>(std::size_t(shape.mask_words()), 0)};
}

}  // namespace

ProducedMip read_mip(const BrickPool& pool, const renderer::TreeShape& shape, int slot, int mip) {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    return read_packed_mip(pool, shape, slot, mip);
}

ProducedBrick read_brick(const BrickPool& pool, const renderer::TreeShape& shape, int slot) {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    if (pool.packed() != nullptr) {
        return pool.packed()->run(slot).words == 0 ? empty_brick(shape)
                                                   : read_packed_brick(pool, shape, slot);
    }
    ProducedBrick brick;
    brick.m = shape.m;
    const glm::ivec3 low = pool.first_texel(slot);
    const int side = shape.m + 2;
    brick.color = read_texels(bound_texture(pool, TEXTURE_BRICK_COLOR, GL_TEXTURE_BINDING_3D), low, side,
                              GL_RGBA, GL_UNSIGNED_BYTE);
    if (!pool.has_color()) {
        // One channel, red, holds the coverage: read as RGBA it is (coverage, 0, 0, 255).
        for (std::uint32_t& texel : brick.color)
            texel = (texel & 255U) << 24U;
    }
    brick.normal = read_texels(bound_texture(pool, TEXTURE_BRICK_NORMAL, GL_TEXTURE_BINDING_3D), low, side,
                               GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV);
    const std::size_t words = std::size_t(mask_words(shape.m));
    brick.masks.resize(words);
    glGetNamedBufferSubData(mask_buffer(pool), GLintptr(std::size_t(slot) * words * 8), GLsizeiptr(words * 8),
                            brick.masks.data());
    return brick;
}

PoolTextures textures_of(const BrickPool& pool) {
    PoolTextures textures;
    textures.color_size = size_of(bound_texture(pool, TEXTURE_BRICK_COLOR, GL_TEXTURE_BINDING_3D));
    textures.normal_size = size_of(bound_texture(pool, TEXTURE_BRICK_NORMAL, GL_TEXTURE_BINDING_3D));
    GLint64 mask_bytes = 0;
    glGetNamedBufferParameteri64v(mask_buffer(pool), GL_BUFFER_SIZE, &mask_bytes);
    textures.bytes = volume(textures.color_size) * (pool.has_color() ? 4 : 1) +
                     volume(textures.normal_size) * 4 + std::size_t(mask_bytes);
    return textures;
}

std::vector<std::uint8_t> slot_content(const BrickPool& pool, int slot) {
    std::vector<std::uint8_t> bytes;
    if (const renderer::PackedBricks* const packed = pool.packed()) {
        const renderer::PackedBricks::Run run = packed->run(slot);
        return packed->words().read_all<std::uint8_t>(std::size_t(run.words) * 4, std::size_t(run.first) * 4);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (const BrickPool::Layer& layer : pool.layers()) {
        const glm::ivec3 low = pool.first_texel(slot, layer.mip);
        const int size = layer.side * layer.side * layer.side * layer.texel_bytes;
        bytes.resize(bytes.size() + std::size_t(size));
        glGetTextureSubImage(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                             layer.format, layer.type, size, &bytes[bytes.size() - std::size_t(size)]);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    const std::size_t mask_bytes = pool.mask_bytes_per_slot();
    const std::vector<std::uint8_t> masks =
        pool.masks().read_all<std::uint8_t>(mask_bytes, std::size_t(slot) * mask_bytes);
    bytes.insert(bytes.end(), masks.begin(), masks.end());
    return bytes;
}

voxelizer::BitGrid mask_bits(const ProducedBrick& brick) {
    return bits_where(0, brick.m, [&](const glm::ivec3& place) { return brick.occupied(place); });
}

voxelizer::BitGrid coverage_bits(const ProducedBrick& brick) {
    return bits_where(-1, brick.m + 2, [&](const glm::ivec3& place) { return brick.color_at(place).a != 0; });
}

std::size_t slot_bytes(int m, bool has_color) {
    return volume(glm::ivec3(m + 2)) * (has_color ? 8 : 5) + std::size_t(mask_words(m)) * 8;
}

BrickMaker::BrickMaker(const renderer::TreeShape& shape, const voxelizer::Surface& surface, int slots)
    : shape_(shape),
      surface_(upload(surface)),
      lists_(renderer::tile_lists(shape, surface)),
      producer_(shape, surface_, lists_, {}),
      pool_(shape, {.color = surface.has_color, .packed = true},
            std::size_t(slots) * renderer::least_packed_bytes(shape, surface.has_color) + 4096) {}

std::vector<ProducedBrick> BrickMaker::produce(const std::vector<renderer::Tile>& tiles) {
    std::vector<renderer::BrickRequest> requests;
    requests.reserve(tiles.size());
    for (const renderer::Tile& tile : tiles)
        requests.push_back({tile, int(requests.size())});
    const std::vector<renderer::ProducedTile> produced = producer_.produce(requests, pool_);
    std::vector<ProducedBrick> bricks;
    bricks.reserve(tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        EXPECT_EQ(produced[i].words_without_room, 0U) << "no room for brick " << i;
        bricks.push_back(produced[i].constant ? empty_brick(shape_) : read_brick(pool_, shape_, int(i)));
    }
    return bricks;
}

}  // namespace cairn::test
