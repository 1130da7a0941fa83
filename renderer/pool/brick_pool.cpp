#include "renderer/pool/brick_pool.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glad/gl.h>

#include "base/error.h"
#include "gl/buffer_offset.h"
#include "gl/buffer_texture.h"
#include "gl/limits.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/produce.h"

namespace cairn::renderer {
namespace {

gl::TextureHandle make_texture(GLenum format, glm::ivec3 size, GLint filter) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &id);
    gl::TextureHandle texture(id);
    glTextureStorage3D(id, 1, format, size.x, size.y, size.z);
    if (glGetError() == GL_OUT_OF_MEMORY) {
        throw Error(Fault::memory, "brick pool", "the driver has no room for it",
                    "choose a smaller PoolSizes::brick_bytes");
    }
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, filter);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glTextureParameteri(id, axis, GL_CLAMP_TO_EDGE);
    }
    return texture;
}

/// The largest box of at most `count` slots with no side over `most`; of several, the one nearest to a cube.
glm::ivec3 box_of(int count, int most) {
    glm::ivec3 best(0);
    auto volume = [](const glm::ivec3& box) { return std::int64_t(box.x) * box.y * box.z; };
    for (int x = std::min(most, int(std::cbrt(double(count)) + 1e-9)); x >= 1; --x) {
        for (int y = x; y <= most && std::int64_t(x) * y * y <= count; ++y) {
            const glm::ivec3 box(x, y, std::min(most, count / (x * y)));
            if (volume(box) > volume(best)) best = box;
        }
    }
    return best;
}

/// Where the mips of a pool lie (BrickPool::levels), and the size of its textures in texels.
struct Layout {
    std::vector<glm::ivec4> levels;
    glm::ivec3 size{0};

    [[nodiscard]] std::size_t texels() const {
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    }
};

Layout lay_out(const TreeShape& shape, const glm::ivec3& slots) {
    Layout layout;
    layout.size = glm::ivec3(slots.x, slots.y, 0) * shape.mip_side(0);
    const int count = slots.x * slots.y * slots.z;
    for (int mip = 0; mip <= shape.mips; ++mip) {
        const int side = shape.mip_side(mip);
        const glm::ivec2 row(layout.size.x / side, layout.size.y / side);
        layout.levels.emplace_back(row, layout.size.z, side);
        layout.size.z += (count + row.x * row.y - 1) / (row.x * row.y) * side;
    }
    return layout;
}

}  // namespace

BrickPool::BrickPool(const TreeShape& shape, Channels channels, std::size_t bytes)
    : shape_(shape), channels_(channels) {
    if (channels.packed) {
        packed_.emplace(shape, channels.color, bytes);
        slot_count_ = packed_->slot_count();
        size_bytes_ = packed_->size_bytes();
        return;
    }
    const std::size_t mask_bytes = mask_bytes_per_slot();
    const std::size_t texel_bytes = (channels.color ? 4U : 1U) + (channels.normal ? 4U : 0U);
    auto bytes_of = [&](const Layout& layout, int slots) {
        return layout.texels() * texel_bytes + std::size_t(slots) * mask_bytes;
    };
    const gl::Limits limits = gl::query_limits();
    const std::size_t least = bytes_of(lay_out(shape, glm::ivec3(1)), 1);
    if (bytes < least) {
        throw Error(
            Fault::usage, "brick pool",
            fmt::format("{:.2f} MiB hold no brick of {}^3 voxels", double(bytes) / 0x1p20, shape.m),
            fmt::format("give it at least {:.2f} MiB", std::ceil(double(least) / 0x1p20 * 100.0) / 100.0));
    }
    const std::size_t side = std::size_t(shape.mip_side(0));
    const std::size_t most_masks =
        std::min(limits.texture_buffer_texels, limits.shader_storage_bytes / 8) * 8 / mask_bytes;
    std::size_t most = std::min<std::size_t>(
        {bytes / (side * side * side * texel_bytes + mask_bytes), most_masks, std::size_t(1) << 22U});
    // Mips lie in whole layers: their size follows only from the layout.
    Layout layout;
    for (;; most -= std::max<std::size_t>(most / 64, 1)) {
        slots_ = box_of(int(most), limits.texture_3d_size / int(side));
        slot_count_ = slots_.x * slots_.y * slots_.z;
        layout = lay_out(shape, slots_);
        if (layout.size.z <= limits.texture_3d_size && bytes_of(layout, slot_count_) <= bytes) break;
    }
    levels_ = layout.levels;
    color_ = make_texture(channels.color ? GL_RGBA8 : GL_R8, layout.size, GL_NEAREST);
    if (channels.normal) normal_ = make_texture(GL_RGB10_A2, layout.size, GL_NEAREST);
    masks_ = gl::Buffer(std::size_t(slot_count_) * mask_bytes, "brick masks");
    mask_texture_ = gl::buffer_texture(GL_RG32UI, masks_);
    size_bytes_ = bytes_of(layout, slot_count_);
}

glm::ivec3 BrickPool::first_texel(int slot, int mip) const {
    const glm::ivec4& level = levels_[std::size_t(mip)];
    return glm::ivec3(slot % level.x, slot / level.x % level.y, slot / (level.x * level.y)) * level.w +
           glm::ivec3(0, 0, level.z);
}

std::vector<BrickPool::Layer> BrickPool::layers() const {
    std::vector<Layer> layers;
    for (std::size_t mip = 0; mip < levels_.size(); ++mip) {
        Layer layer{color_.id(), GL_RED, GL_UNSIGNED_BYTE, int(mip), levels_[mip].w, 1};
        if (channels_.color) {
            layer.format = GL_RGBA;
            layer.texel_bytes = 4;
        }
        layers.push_back(layer);
        if (!channels_.normal) continue;
        layers.push_back(
            {normal_.id(), GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, int(mip), levels_[mip].w, 4});
    }
    return layers;
}

std::size_t BrickPool::used_bytes(int bricks) const {
    if (packed_) return packed_->used_bytes();
    return size_bytes_ / std::size_t(slot_count_) * std::size_t(bricks);
}

bool BrickPool::reserve(int slot, std::uint32_t words) {
    while (!packed_->reserve(slot, words)) {
        if (!evict_ || !evict_(slot)) return false;
    }
    return true;
}

void BrickPool::bind_for_reading() const {
    if (packed_) {
        packed_->bind_for_reading();
        return;
    }
    glBindTextureUnit(TEXTURE_BRICK_MASKS, mask_texture_.id());
    glBindTextureUnit(TEXTURE_BRICK_COLOR, color_.id());
    glBindTextureUnit(TEXTURE_BRICK_NORMAL, normal_.id());
}

void BrickPool::bind_for_writing() const {
    if (packed_) {
        packed_->bind_for_writing();
        return;
    }
    glBindImageTexture(IMAGE_BRICK_COLOR, color_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY,
                       channels_.color ? GL_RGBA8 : GL_R8);
    if (channels_.normal)
        glBindImageTexture(IMAGE_BRICK_NORMAL, normal_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGB10_A2);
    masks_.bind_storage(SSBO_BRICK_MASKS);
}

void BrickPool::upload(int slot, const gl::Buffer& texels, std::size_t offset_bytes,
                       std::span<const std::uint64_t> masks) const {
    const glm::ivec3 texel = first_texel(slot);
    const int side = levels_.front().w;
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, texels.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(color_.id(), 0, texel.x, texel.y, texel.z, side, side, side, GL_RED, GL_UNSIGNED_BYTE,
                        gl::buffer_offset(offset_bytes));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glNamedBufferSubData(masks_.id(), GLintptr(std::size_t(slot) * mask_bytes_per_slot()),
                         GLsizeiptr(masks.size_bytes()), masks.data());
}

}  // namespace cairn::renderer
