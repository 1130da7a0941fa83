#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <glad/gl.h>

#include "gl/buffer.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/tree.h"

namespace cairn::renderer {

/// A cache in main memory for bricks that had to leave the pool: larger and slower than the pool, and bounded
/// in bytes. It drops the brick that was not asked for for longest. A brick that comes back has the same
/// texels and masks, bit for bit.
///
/// Bricks are read back through a ring of pixel-pack buffers, each with a fence. So the CPU waits for the
/// driver only if a brick is wanted at once, or if the ring is full.
class BrickCache {
public:
    /// Refers to the pool, which must outlive it.
    /// @param limit_bytes  bytes of all kept bricks and their records; room for one brick at least, and if
    ///                     bricks are packed, for one whose voxels are all occupied.
    /// @throws Error (Fault::usage) if not one brick fits.
    BrickCache(const TreeShape& shape, BrickPool& pool, std::size_t limit_bytes);

    /// Keeps the bricks that these slots still hold. Call it before anything else is written to the slots, or
    /// where packed bricks were.
    void store(std::span<const Tree::EvictedBrick> evicted);

    enum class Restored : std::uint8_t { yes, not_cached, no_room };
    /// Writes the tile's brick to the slot, if the cache holds it and the pool has room for it.
    [[nodiscard]] Restored restore(const Tile& tile, int slot);

    struct Counters {
        std::uint64_t stored = 0;    ///< bricks read back
        std::uint64_t restored = 0;  ///< bricks written to the pool again
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }
    [[nodiscard]] std::size_t size_bytes() const { return kept_bytes_; }

private:
    struct Brick {
        Tile tile;
        std::vector<std::uint8_t> bytes;
    };
    struct DeleteSync {
        void operator()(GLsync sync) const { glDeleteSync(sync); }
    };
    using Fence = std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteSync>;
    /// A brick on its way to main memory, for as long as `fence` is set.
    struct Readback {
        gl::Buffer buffer;
        Fence fence;
        Tile tile;
        std::size_t bytes = 0;
    };
    // One node of the list, one of the map, and a vector.
    static constexpr std::size_t record_bytes = 128;
    static constexpr std::size_t ring_size = 32;

    void start_readback(Readback& readback, const Tree::EvictedBrick& evicted) const;
    void read_dense(const gl::Buffer& to, int slot) const;
    void write_dense(int slot) const;
    [[nodiscard]] bool write_packed(int slot, std::size_t bytes);
    /// Bytes of the brick that the slot holds or has just lost.
    [[nodiscard]] std::size_t brick_bytes(int slot) const;
    void finish(Readback& readback);
    void keep(const Tile& tile, std::vector<std::uint8_t> bytes);
    [[nodiscard]] bool holds(const Tile& tile) const;

    BrickPool& pool_;
    std::size_t limit_bytes_;
    std::size_t kept_bytes_ = 0;
    std::vector<BrickPool::Layer> layers_;
    std::size_t masks_offset_ = 0;  // where masks start in a brick's bytes, behind the texels of all layers
    std::size_t dense_bytes_ = 0;
    std::list<Brick> order_;  // the brick used last comes first
    std::unordered_map<Tile, std::list<Brick>::iterator, TileHash> bricks_;
    std::array<Readback, ring_size> ring_;
    std::size_t next_readback_ = 0;
    gl::Buffer upload_buffer_;
    Counters counters_;
};

}  // namespace cairn::renderer
