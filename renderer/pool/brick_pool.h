#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/pool/packed_bricks.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The bounded store of bricks on the GPU (Crassin et al. 2008, section 4.2): PackedBricks for surfaces
/// (Channels::packed), dense bricks for all else.
///
/// A slot of dense bricks holds a brick and its mip levels, at one address in three stores:
///
///     color    3D texture, (M + 2)^3 texels per slot: RGBA8 (square root of linear colour times coverage,
///              coverage), or R8 coverage (of a volume: density) alone if the content has no colour
///     normal   3D texture, RGB10_A2, if the content has normals: two normals per texel, as
///              shaders/pool/brick_normals.glsl packs them
///     masks    64-bit words: the summary, which marks the blocks of b^3 voxels that are not empty (1 word
///     per
///              64 blocks), then one word per block, which marks its occupied voxels in bit x + b (y + b z).
///              b = TreeShape::block_side(): 4, or 3 if n = 3
///
/// Mip k has (M / 2^k + 2)^3 texels per slot, border included, and lies in layers of its own behind those of
/// mip k - 1: a sibling pool with as many slots, in rows of its own length. So a slot's number is its address
/// in all mips (section 4.2), and one texture has to be bound, not one per mip. The blocks of mip k follow
/// those of mip k - 1; the summary covers all mips. Mips of dense bricks add an eighth of the memory, and a
/// little for the border: a fifth for M = 16 and N = 4.
class BrickPool {
public:
    /// Makes as many slots as fit in `bytes`.
    /// @throws Error (Fault::usage) if not one slot fits; names the least size.
    BrickPool(const TreeShape& shape, Channels channels, std::size_t bytes);
    BrickPool(const TreeShape& shape, bool has_color, std::size_t bytes)
        : BrickPool(shape, Channels{.color = has_color}, bytes) {}

    [[nodiscard]] const PackedBricks* packed() const { return packed_ ? &*packed_ : nullptr; }

    /// Gives a slot room for a packed brick of so many words. Evicts others for it, if make_room_by() was
    /// called.
    /// @return  false if there is no room.
    [[nodiscard]] bool reserve(int slot, std::uint32_t words);
    /// The slot holds no brick any more.
    void release(int slot) {
        if (packed_) packed_->release(slot);
    }
    /// @param evict  evicts a brick so that this slot may have its room, and releases its slot; false if
    /// there
    ///               is none that may go.
    void make_room_by(std::function<bool(int slot)> evict) { evict_ = std::move(evict); }
    /// Sends to the GPU where bricks are. Call it before rays march again.
    void upload() {
        if (packed_) packed_->upload();
    }

    [[nodiscard]] int slot_count() const { return slot_count_; }
    [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }
    /// Bytes that so many bricks, all that are in the pool, take of it.
    [[nodiscard]] std::size_t used_bytes(int bricks) const;
    /// Slots of mip 0 of dense bricks along each axis.
    [[nodiscard]] glm::ivec3 slots() const { return slots_; }
    [[nodiscard]] glm::ivec3 first_texel(int slot, int mip = 0) const;
    /// One vector per mip, for shaders/pool/brick_levels.glsl: slots along x, slots along y, first layer,
    /// texels per side of a slot.
    [[nodiscard]] const std::vector<glm::ivec4>& levels() const { return levels_; }
    [[nodiscard]] bool has_color() const { return channels_.color; }
    /// 64-bit words of masks per slot.
    [[nodiscard]] std::size_t mask_words() const { return std::size_t(shape_.mask_words()); }

    /// The part of every slot that holds one mip in one texture: a cube of `side` texels at first_texel().
    struct Layer {
        std::uint32_t texture = 0;  ///< OpenGL's name of the texture
        std::uint32_t format = 0;   ///< a GLenum: how pixels are transferred, bit for bit
        std::uint32_t type = 0;     ///< a GLenum: the type of a pixel's components as they are transferred
        int mip = 0;
        int side = 0;
        int texel_bytes = 0;
    };
    /// All layers of a slot of dense bricks; only its masks are not among them.
    [[nodiscard]] std::vector<Layer> layers() const;
    /// The masks of slot s start at byte s * mask_bytes_per_slot().
    [[nodiscard]] const gl::Buffer& masks() const { return masks_; }
    [[nodiscard]] std::size_t mask_bytes_per_slot() const { return mask_words() * 8; }

    /// Binds sampled textures, for the marcher.
    void bind_for_reading() const;
    /// Binds images and the mask buffer, for a producer.
    void bind_for_writing() const;

    /// Writes a whole slot from the CPU. Only for a pool of one channel.
    /// @param texels  holds (M + 2)^3 bytes from `offset_bytes` on, x fastest.
    /// @param masks   mask_words() words.
    void upload(int slot, const gl::Buffer& texels, std::size_t offset_bytes,
                std::span<const std::uint64_t> masks) const;

private:
    TreeShape shape_;
    Channels channels_;
    std::optional<PackedBricks> packed_;
    std::function<bool(int)> evict_;
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
