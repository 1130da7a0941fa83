#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/pool/run_allocator.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The bricks of surfaces on the GPU: bounded in bytes, and each as long as the voxels in it that are
/// occupied. A brick is a run of 32-bit words, laid out as shaders/pool/packed_brick.glsl says; a table holds
/// the first word of each slot's brick. A dense brick of 16^3 voxels takes 46 KB, of which a surface occupies
/// about a tenth.
class PackedBricks {
public:
    /// @param bytes  of all words and of the table.
    /// @throws Error (Fault::usage) if a brick whose voxels are all occupied does not fit; names the least
    /// size.
    PackedBricks(const TreeShape& shape, bool has_color, std::size_t bytes);

    [[nodiscard]] int slot_count() const { return int(runs_.size()); }
    [[nodiscard]] std::size_t size_bytes() const { return words_.size_bytes() + starts_.size_bytes(); }

    /// Consecutive words.
    struct Run {
        std::uint32_t first = 0;
        std::uint32_t words = 0;
    };

    /// Gives a slot room for a brick of so many words, in place of the brick that it has.
    /// @return  false if there is no room; the slot then has none.
    [[nodiscard]] bool reserve(int slot, std::uint32_t words);
    /// Takes a slot's room back. What is there stays until other bricks are written there.
    void release(int slot);
    [[nodiscard]] bool has_room(int slot) const { return runs_[std::size_t(slot)].is_taken; }
    /// The room of a slot; after release() the one that it had, until it gets another.
    [[nodiscard]] const Run& run(int slot) const { return runs_[std::size_t(slot)].run; }
    [[nodiscard]] std::size_t free_words() const;
    [[nodiscard]] std::size_t used_bytes() const { return words_.size_bytes() - free_words() * 4; }
    /// Of the bricks that are there, rounded to what they take; 0 if there are none.
    [[nodiscard]] std::size_t mean_words() const;

    /// Sends the places of bricks that got room to the GPU. Call it before rays march again.
    void upload();
    void bind_for_reading() const;
    void bind_for_writing() const;
    [[nodiscard]] const gl::Buffer& words() const { return words_; }

private:
    struct SlotRun {
        Run run;
        bool is_taken = false;
    };

    std::vector<SlotRun> runs_;
    std::size_t taken_ = 0;  // slots that have room
    RunAllocator room_{0};
    std::vector<int> moved_;  // slots whose place the GPU does not know yet
    gl::Buffer words_;
    gl::Buffer starts_;
    gl::TextureHandle word_texture_;
    gl::TextureHandle start_texture_;
};

/// Bytes of the smallest pool.
[[nodiscard]] std::size_t least_packed_bytes(const TreeShape& shape, bool has_color);

/// Words of a brick whose voxels are all occupied.
[[nodiscard]] std::size_t most_packed_words(const TreeShape& shape, bool has_color);

}  // namespace cairn::renderer
