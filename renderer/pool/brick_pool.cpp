#include "renderer/pool/brick_pool.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/bindings.h"

namespace cairn::renderer {
namespace {

gl::TextureHandle make_texture(GLenum format, glm::ivec3 size, GLint filter) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &id);
    gl::TextureHandle texture(id);
    glTextureStorage3D(id, 1, format, size.x, size.y, size.z);
    if (glGetError() == GL_OUT_OF_MEMORY) {
        throw Error(Fault::memory, "brick pool", "the driver has no room for it",
                    "choose a smaller --brick-pool");
    }
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, filter);
    for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glTextureParameteri(id, axis, GL_CLAMP_TO_EDGE);
    }
    return texture;
}

/// The largest box of at most `count` slots, no side past `most`; of several, the one nearest to a cube.
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

}  // namespace

BrickPool::BrickPool(const TreeShape& shape, Channels channels, std::size_t bytes)
    : channels_(channels), side_(shape.m + 2) {
    const auto blocks = std::size_t(shape.blocks());
    const std::size_t mask_words = blocks + (blocks + 63) / 64;
    const std::size_t texels = std::size_t(side_) * std::size_t(side_) * std::size_t(side_);
    const std::size_t texel_bytes = (channels.color ? 4U : 1U) + (channels.normal ? 4U : 0U);
    const std::size_t slot_bytes = texels * texel_bytes + mask_words * 8;
    mask_words_ = mask_words;
    const gl::Limits limits = gl::query_limits();
    const int most_a_side = limits.texture_3d_size / side_;
    const std::size_t most_masks =
        std::min(limits.texture_buffer_texels, limits.shader_storage_bytes / 8) / mask_words;
    const std::size_t most = std::min<std::size_t>({bytes / slot_bytes, most_masks, 1U << 22U});
    if (most == 0) {
        throw Error(Fault::usage, "brick pool",
                    fmt::format("{:.2f} MiB hold no brick of {}^3 voxels", double(bytes) / 0x1p20, shape.m),
                    fmt::format("give it at least {:.2f} MiB",
                                std::ceil(double(slot_bytes) / 0x1p20 * 100.0) / 100.0));
    }
    slots_ = box_of(int(most), most_a_side);
    slot_count_ = slots_.x * slots_.y * slots_.z;

    const glm::ivec3 size = slots_ * side_;
    color_ = make_texture(channels.color ? GL_RGBA8 : GL_R8, size, GL_NEAREST);
    if (channels.normal) normal_ = make_texture(GL_RGB10_A2, size, GL_NEAREST);
    masks_ = gl::Buffer(std::size_t(slot_count_) * mask_words * 8, "brick masks");
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    mask_texture_ = gl::TextureHandle(id);
    glTextureBuffer(id, GL_RG32UI, masks_.id());
    size_bytes_ = std::size_t(slot_count_) * slot_bytes;
}

glm::ivec3 BrickPool::slot_place(int slot) const {
    return {slot % slots_.x, slot / slots_.x % slots_.y, slot / (slots_.x * slots_.y)};
}

glm::ivec3 BrickPool::first_texel(int slot) const {
    return slot_place(slot) * side_;
}

std::vector<BrickPool::Layer> BrickPool::layers() const {
    const Layer color = channels_.color ? Layer{color_.id(), GL_RGBA, GL_UNSIGNED_BYTE, side_, 4}
                                        : Layer{color_.id(), GL_RED, GL_UNSIGNED_BYTE, side_, 1};
    if (!channels_.normal) return {color};
    return {color, {normal_.id(), GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, side_, 4}};
}

void BrickPool::bind_for_reading() const {
    glBindTextureUnit(TEXTURE_BRICK_MASKS, mask_texture_.id());
    glBindTextureUnit(TEXTURE_BRICK_COLOR, color_.id());
    glBindTextureUnit(TEXTURE_BRICK_NORMAL, normal_.id());
}

void BrickPool::bind_for_writing() const {
    glBindImageTexture(IMAGE_BRICK_COLOR, color_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY,
                       channels_.color ? GL_RGBA8 : GL_R8);
    if (channels_.normal)
        glBindImageTexture(IMAGE_BRICK_NORMAL, normal_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGB10_A2);
    masks_.bind_storage(SSBO_BRICK_MASKS);
}

void BrickPool::upload(int slot, const gl::Buffer& texels, std::size_t offset_bytes,
                       std::span<const std::uint64_t> masks) const {
    const glm::ivec3 texel = first_texel(slot);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, texels.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    // With a buffer bound, the pointer is an offset in it.
    glTextureSubImage3D(color_.id(), 0, texel.x, texel.y, texel.z, side_, side_, side_, GL_RED,
                        GL_UNSIGNED_BYTE, reinterpret_cast<const void*>(offset_bytes));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glNamedBufferSubData(masks_.id(), GLintptr(std::size_t(slot) * mask_words_ * 8),
                         GLsizeiptr(masks.size_bytes()), masks.data());
}

}  // namespace cairn::renderer
