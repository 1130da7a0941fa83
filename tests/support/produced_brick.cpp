#include "tests/support/produced_brick.h"

#include <cmath>

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

ProducedBrick read_brick(const BrickPool& pool, const renderer::TreeShape& shape, int slot) {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
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
      pool_(shape, surface.has_color, std::size_t(slots) * slot_bytes(shape.m, surface.has_color)) {}

std::vector<ProducedBrick> BrickMaker::produce(const std::vector<renderer::Tile>& tiles) {
    std::vector<renderer::BrickRequest> requests;
    requests.reserve(tiles.size());
    for (const renderer::Tile& tile : tiles)
        requests.push_back({tile, int(requests.size())});
    producer_.produce(requests, pool_);
    std::vector<ProducedBrick> bricks;
    bricks.reserve(tiles.size());
    for (const renderer::BrickRequest& request : requests)
        bricks.push_back(read_brick(pool_, shape_, request.slot));
    return bricks;
}

}  // namespace cairn::test
