#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// What a voxel of a brick has beside its coverage, or density.
struct Channels {
    bool color = false;
    bool normal = true;
};

/// The bounded store of bricks on the GPU (Crassin et al. 2008, section 4.2).
///
/// A slot holds, at one address in each of these, a brick and its mip levels:
///     color    3D texture, (M + 2)^3 texels a slot: RGBA8 (square root of linear colour times coverage,
///     coverage),
///              or R8 coverage (of a volume: density) alone when the scene has no colour
///     normal   3D texture, RGB10_A2: two normals, as shaders/pool/brick_normals.glsl packs them; where there
///     are normals masks    64-bit words: which blocks of b^3 voxels are not empty (1 word for each 64
///     blocks), then one word a block:
///              which of its voxels are occupied; bit x + b (y + b z). b = TreeShape::block_side(): 4, or 3
///              where n = 3
///
/// Mip k has (M / 2^k + 2)^3 texels a slot, border included, and lies in layers of its own behind those of
/// mip k - 1: a sibling pool with as many slots, in rows of its own length. So a slot's number is its address
/// in all of them (section 4.2), and one texture, not one a mip, has to be bound. The blocks of mip k follow
/// those of mip k - 1; the summary tells of all. Mips add an eighth and a bit for the border: for M = 16 and
/// N = 4 a fifth.
class BrickPool {
public:
    /// As many slots as fit in `bytes`. @throws Error (Fault::usage) when not one does, naming the least.
    BrickPool(const TreeShape& shape, Channels channels, std::size_t bytes);
    BrickPool(const TreeShape& shape, bool has_color, std::size_t bytes)
        : BrickPool(shape, Channels{.color = has_color}, bytes) {}

    [[nodiscard]] int slot_count() const { return slot_count_; }
    [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }
    /// Of mip 0, along each axis.
    [[nodiscard]] glm::ivec3 slots() const { return slots_; }
    [[nodiscard]] glm::ivec3 first_texel(int slot, int mip = 0) const;
    /// For shaders/pool/brick_levels.glsl, of each mip: slots along x and y, first layer, texels of a slot's
    /// side.
    [[nodiscard]] const std::vector<glm::ivec4>& levels() const { return levels_; }
    [[nodiscard]] bool has_color() const { return channels_.color; }
    /// 64-bit words of masks a slot.
    [[nodiscard]] std::size_t mask_words() const { return std::size_t(shape_.mask_words()); }

    /// What every slot has of a mip in a texture of the pool: a cube of `side` texels at first_texel().
    struct Layer {
        std::uint32_t texture = 0;  ///< OpenGL's name of it
        std::uint32_t format = 0;   ///< a GLenum: how pixels are transferred, bit for bit
        std::uint32_t type = 0;     ///< a GLenum: the type of a pixel's components as they are transferred
        int mip = 0;
        int side = 0;
        int texel_bytes = 0;
    };
    /// All that a slot holds, but for its masks.
    [[nodiscard]] std::vector<Layer> layers() const;
    /// The masks of slot s start at byte s * mask_bytes_a_slot().
    [[nodiscard]] const gl::Buffer& masks() const { return masks_; }
    [[nodiscard]] std::size_t mask_bytes_a_slot() const { return mask_words() * 8; }

    /// For the marcher: sampled textures. For the producer: images and the mask buffer.
    void bind_for_reading() const;
    void bind_for_writing() const;

    /// Writes a whole slot from the CPU; a pool of one channel only.
    /// @param texels  holds (M + 2)^3 bytes from `offset_bytes` on, x fastest.
    /// @param masks   mask_words() words.
    void upload(int slot, const gl::Buffer& texels, std::size_t offset_bytes,
                std::span<const std::uint64_t> masks) const;

private:
    TreeShape shape_;
    Channels channels_;
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
