#include "renderer/produce/cpu_brick.h"

#include <algorithm>
#include <cmath>

#include <glad/gl.h>

#include "renderer/pool/brick_pool.h"

namespace cairn::renderer {
namespace {

/// octahedral_place() of shaders/pool/brick_normals.glsl (Cigolle et al. 2014).
glm::vec2 octahedral_place(const glm::vec3& n) {
    const glm::vec2 e = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    if (n.z >= 0.0F) return e;
    return (1.0F - glm::abs(glm::vec2(e.y, e.x))) *
           glm::vec2(e.x >= 0.0F ? 1.0F : -1.0F, e.y >= 0.0F ? 1.0F : -1.0F);
}

/// pack_normal() of shaders/pool/brick_normals.glsl: one normal, whose second is the same and has no share.
std::uint32_t packed(const glm::vec3& n) {
    if (n == glm::vec3(0.0F)) return 0;
    const glm::vec2 place = octahedral_place(n);
    const glm::uvec2 first(glm::round(place * 255.0F + 256.0F));
    const glm::uvec2 second(glm::round(place * 31.0F + 31.0F));
    return first.x | first.y << 9U | second.x << 18U | second.y << 24U;
}

std::uint8_t byte_of(double share) {
    return std::uint8_t(std::lround(std::clamp(share, 0.0, 1.0) * 255.0));
}

/// The number of a cell in a cube of cells, x fastest.
std::size_t place_in(const glm::ivec3& cell, int side) {
    const auto n = std::size_t(side);
    return std::size_t(cell.x) + n * (std::size_t(cell.y) + n * std::size_t(cell.z));
}

}  // namespace

CpuBrick::CpuBrick(const TreeShape& shape, Channels channels) : shape_(shape), channels_(channels) {
    const auto side = std::size_t(shape.mip_side(0));
    const std::size_t count = side * side * side;
    texels_.resize(count * (channels.color ? 4U : 1U));
    if (channels.normal) normals_.resize(count);
    masks_.resize(std::size_t(shape.mask_words()));
}

void CpuBrick::set(const glm::ivec3& place, double coverage, const glm::vec3& normal,
                   const glm::vec3& color) {
    const int side = shape_.mip_side(0);
    const glm::ivec3 texel = place + 1;
    const auto index = place_in(texel, side);
    const std::uint8_t covered = byte_of(coverage);
    const std::size_t alpha = channels_.color ? 4 * index + 3 : index;
    const bool was_occupied = texels_[alpha] != 0;
    const bool is_occupied = covered != 0;
    texels_[alpha] = covered;
    if (channels_.color) {
        for (int c = 0; c < 3; ++c)
            texels_[4 * index + std::size_t(c)] = byte_of(std::sqrt(double(color[c]) * coverage));
    }
    if (channels_.normal) normals_[index] = is_occupied ? packed(normal) : 0;
    occupied_ = occupied_ + (is_occupied ? 1U : 0U) - (was_occupied ? 1U : 0U);

    const bool border = glm::any(glm::lessThan(place, glm::ivec3(0))) ||
                        glm::any(glm::greaterThanEqual(place, glm::ivec3(shape_.m)));
    if (border) return;
    const int block_side = shape_.block_side();
    const int across = shape_.m / block_side;
    const glm::ivec3 block = place / block_side;
    const glm::ivec3 in = place % block_side;
    const auto number = place_in(block, across);
    const std::size_t summaries = (std::size_t(shape_.blocks()) + 63) / 64;
    const std::uint64_t voxel = std::uint64_t(1) << unsigned(in.x + block_side * (in.y + block_side * in.z));
    std::uint64_t& word = masks_[summaries + number];
    word = is_occupied ? word | voxel : word & ~voxel;
    const std::uint64_t summary = std::uint64_t(1) << (number % 64);
    masks_[number / 64] = word != 0 ? masks_[number / 64] | summary : masks_[number / 64] & ~summary;
}

void CpuBrick::send_to(const BrickPool& pool, int slot) const {
    const glm::ivec3 low = pool.first_texel(slot);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    bool is_color = true;  // the first layer of a mip
    for (const BrickPool::Layer& layer : pool.layers()) {
        if (layer.mip != 0) break;
        const void* texels = is_color ? static_cast<const void*>(texels_.data()) : normals_.data();
        glTextureSubImage3D(layer.texture, 0, low.x, low.y, low.z, layer.side, layer.side, layer.side,
                            layer.format, layer.type, texels);
        is_color = false;
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glNamedBufferSubData(pool.masks().id(), GLintptr(std::size_t(slot) * pool.mask_bytes_per_slot()),
                         GLsizeiptr(masks_.size() * 8), masks_.data());
}

}  // namespace cairn::renderer
