#include "tests/support/box_content.h"

#include <algorithm>

#include <glad/gl.h>

#include "renderer/pool/brick_pool.h"
#include "shaders/interop/pool.h"

namespace cairn::test {
namespace {

using renderer::BrickPool;
using renderer::Tile;

GLuint bound(GLenum unit, GLenum kind) {
    glActiveTexture(GL_TEXTURE0 + unit);
    GLint id = 0;
    glGetIntegerv(kind, &id);
    return GLuint(id);
}

constexpr std::uint32_t no_normal = 0;  // shaders/pool/brick_normals.glsl
constexpr std::uint32_t upwards = 256U | 511U << 9U;

}  // namespace

BoxContent::BoxContent(const renderer::TreeShape& shape, const BoxOptions& options)
    : shape_(shape), options_(options) {
    grid_.voxel_size = 1.0 / shape.resolution();
    grid_.resolution = glm::ivec3(shape.resolution());
}

glm::u8vec4 BoxContent::texel(const glm::i64vec3& v, int level) const {
    const glm::dvec3 centre = (glm::dvec3(v) + 0.5) / double(shape_.m * shape_.tiles_across(level));
    if (glm::any(glm::lessThan(centre, glm::dvec3(0.0))) ||
        glm::any(glm::greaterThan(centre, glm::dvec3(1.0))))
        return glm::u8vec4(0);
    if (centre.y < 1.0 / shape_.m) return floor;
    const double low = double(options_.margin) / options_.n;
    const bool in_box = glm::all(glm::greaterThan(centre, glm::dvec3(low))) &&
                        glm::all(glm::lessThan(centre, glm::dvec3(1.0 - low)));
    return in_box ? fog : glm::u8vec4(0);
}

bool BoxContent::is_empty(const Tile& tile) {
    const double side = 1.0 / shape_.tiles_across(tile.level);
    const glm::dvec3 low = glm::dvec3(tile.position) * side;
    const double box_low = double(options_.margin) / options_.n;
    const double rounding = 1e-9;
    const bool in_box = glm::all(glm::greaterThan(low + side, glm::dvec3(box_low + rounding))) &&
                        glm::all(glm::lessThan(low, glm::dvec3(1.0 - box_low - rounding)));
    return !in_box && low.y > 1.0 / shape_.m - rounding;
}

glm::uvec2 BoxContent::child_mask(const Tile& tile) {
    glm::uvec2 mask(0);
    if (tile.level >= shape_.max_level) return mask;
    for (int child = 0; child < shape_.child_count(); ++child) {
        if (is_empty(child_of(tile, shape_.n, child))) continue;
        const glm::ivec3 group = glm::ivec3(child % 8, child / 8 % 8, child / 64) / 2;
        const int bit = shape_.n == 8 ? group.x + 4 * (group.y + 4 * group.z) : child;
        mask[bit / 32] |= 1U << (bit % 32);
    }
    return mask;
}

std::vector<renderer::ProducedTile> BoxContent::produce(std::span<const renderer::BrickRequest> requests,
                                                        BrickPool& pool) {
    std::vector<renderer::ProducedTile> out;
    const int side = shape_.m + 2;
    for (const auto& [tile, slot] : requests) {
        std::vector<glm::u8vec4> texels;
        texels.reserve(std::size_t(side) * std::size_t(side) * std::size_t(side));
        for (int i = 0; i < side * side * side; ++i) {
            const glm::i64vec3 place(i % side - 1, i / side % side - 1, i / (side * side) - 1);
            texels.push_back(texel(tile.position * std::int64_t(shape_.m) + place, tile.level));
        }
        write(pool, slot, texels);
        renderer::ProducedTile& produced = out.emplace_back();
        produced.constant =
            options_.constant &&
            std::all_of(texels.begin(), texels.end(), [&](const auto& t) { return t == texels.front(); });
        produced.mean = produced.constant ? texels.front() : glm::u8vec4(0);
        produced.low_frequency = options_.low_frequency && tile.level >= 1 &&
                                 tile.position.x < shape_.tiles_across(tile.level) / 2;
        produced_.push_back(tile);
    }
    return out;
}

void BoxContent::write(const BrickPool& pool, int slot, const std::vector<glm::u8vec4>& texels) const {
    const int side = shape_.m + 2;
    const int b = shape_.block_side();
    const int across = shape_.m / b;
    const std::size_t summaries = (std::size_t(shape_.blocks()) + 63) / 64;
    std::vector<std::uint64_t> masks(summaries + std::size_t(shape_.blocks()), 0);
    std::vector<std::uint32_t> normals;
    normals.reserve(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        normals.push_back(texels[i] == floor ? upwards : no_normal);
        const glm::ivec3 v(int(i) % side - 1, int(i) / side % side - 1, int(i) / (side * side) - 1);
        const bool border = glm::any(glm::lessThan(v, glm::ivec3(0))) ||
                            glm::any(glm::greaterThanEqual(v, glm::ivec3(shape_.m)));
        if (border || texels[i].a == 0) continue;
        const glm::ivec3 block = v / b;
        const glm::ivec3 in = v % b;
        const auto number = std::size_t(block.x + across * (block.y + across * block.z));
        masks[summaries + number] |= std::uint64_t(1) << unsigned(in.x + b * (in.y + b * in.z));
        masks[number / 64] |= std::uint64_t(1) << (number % 64);
    }
    pool.bind_for_reading();
    const glm::ivec3 low = pool.first_texel(slot);
    glTextureSubImage3D(bound(TEXTURE_BRICK_COLOR, GL_TEXTURE_BINDING_3D), 0, low.x, low.y, low.z, side, side,
                        side, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glTextureSubImage3D(bound(TEXTURE_BRICK_NORMAL, GL_TEXTURE_BINDING_3D), 0, low.x, low.y, low.z, side,
                        side, side, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, normals.data());
    GLint buffer = 0;
    glGetTextureLevelParameteriv(bound(TEXTURE_BRICK_MASKS, GL_TEXTURE_BINDING_BUFFER), 0,
                                 GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
    glNamedBufferSubData(GLuint(buffer), GLintptr(std::size_t(slot) * masks.size() * 8),
                         GLsizeiptr(masks.size() * 8), masks.data());
}

}  // namespace cairn::test
