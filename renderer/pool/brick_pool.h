#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The bounded store of bricks on the GPU (Crassin et al. 2008, section 4.2).
///
/// A slot holds, at one address in each of these, a brick and its mip levels:
///     color    3D texture, (M + 2)^3 texels a slot: RGBA8 (square root of linear colour times coverage,
///     coverage),
///              or R8 coverage alone when the scene has no colour
///     normal   3D texture, RGB10_A2: normal times coverage, 0.5 = zero
///     masks    64-bit words: which 4^3 blocks are not empty (1 word for each 64 blocks), then one word a
///     block:
///              which of its 4^3 voxels are occupied; bit x + 4 (y + 4 z)
///
/// Mip k has (M / 2^k + 2)^3 texels a slot, border included, and lies in layers of its own behind those of
/// mip k - 1: a sibling pool with as many slots, in rows of its own length. So a slot's number is its address
/// in all of them (section 4.2), and one texture, not one a mip, has to be bound. The blocks of mip k follow
/// those of mip k - 1; the summary tells of all. Mips add an eighth and a bit for the border: for M = 16 and
/// N = 4 a fifth.
class BrickPool {
public:
    /// As many slots as fit in `bytes`. @throws Error (Fault::usage) when not one does, naming the least.
    BrickPool(const TreeShape& shape, bool has_color, std::size_t bytes);

    [[nodiscard]] int slot_count() const { return slot_count_; }
    [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }
    /// Of mip 0, along each axis.
    [[nodiscard]] glm::ivec3 slots() const { return slots_; }
    [[nodiscard]] glm::ivec3 first_texel(int slot, int mip = 0) const;
    /// For shaders/pool/brick_levels.glsl, of each mip: slots along x and y, first layer, texels of a slot's
    /// side.
    [[nodiscard]] const std::vector<glm::ivec4>& levels() const { return levels_; }
    /// 64-bit words of a slot's masks.
    [[nodiscard]] static int mask_words(const TreeShape& shape);
    [[nodiscard]] bool has_color() const { return has_color_; }

    /// For the marcher: sampled textures. For the producer: images and the mask buffer.
    void bind_for_reading() const;
    void bind_for_writing() const;

private:
    bool has_color_;
    int slot_count_ = 0;
    std::size_t size_bytes_ = 0;
    glm::ivec3 slots_{0};
    std::vector<glm::ivec4> levels_;
    gl::TextureHandle color_;
    gl::TextureHandle normal_;
    gl::TextureHandle mask_texture_;
    gl::Buffer masks_;
};

}  // namespace cairn::renderer
