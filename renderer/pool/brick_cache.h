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

/// Bricks that had to leave the pool, in main memory: a larger, slower cache behind it, bounded in bytes,
/// which forgets what was not asked for for longest. A brick that comes back has the same texels and masks,
/// bit for bit.
///
/// Bricks are read back through a ring of pixel-pack buffers, each with a fence, so that nobody waits for the
/// driver unless the brick is wanted at once or the ring is full.
class BrickCache {
public:
    /// Refers to the pool, which must outlive it.
    /// @param limit_bytes  of what is kept, the records about it included; at least one brick.
    /// @throws Error (Fault::usage) when not one brick fits.
    BrickCache(const BrickPool& pool, std::size_t limit_bytes);

    /// Keeps what these slots still hold. Call it before anything else is written to them.
    void store(std::span<const Tree::Evicted> evicted);

    /// Writes the tile's brick to the slot. @return false: it is not here.
    [[nodiscard]] bool restore(const Tile& tile, int slot);

    struct Counters {
        std::uint64_t stored = 0;    ///< bricks read back
        std::uint64_t restored = 0;  ///< bricks written to the pool again
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }
    [[nodiscard]] std::size_t size_bytes() const { return order_.size() * (brick_bytes_ + record_bytes); }

private:
    struct Brick {
        Tile tile;
        std::vector<std::uint8_t> bytes;
    };
    struct DeleteSync {
        void operator()(GLsync sync) const { glDeleteSync(sync); }
    };
    using Fence = std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteSync>;
    /// A brick on its way here, while it has a fence.
    struct Reading {
        gl::Buffer buffer;
        Fence fence;
        Tile tile;
    };
    static constexpr std::size_t record_bytes = 128;  // a list's node, a map's node, a vector
    static constexpr std::size_t ring_size = 32;

    void start_reading(Reading& reading, const Tree::Evicted& evicted) const;
    void finish(Reading& reading);
    void keep(const Tile& tile, std::vector<std::uint8_t> bytes);
    [[nodiscard]] bool knows(const Tile& tile) const;

    const BrickPool& pool_;
    std::size_t limit_bytes_;
    std::vector<BrickPool::Layer> layers_;
    std::size_t masks_offset_ = 0;  // in a brick's bytes, behind the texels of all layers
    std::size_t brick_bytes_ = 0;
    std::list<Brick> order_;  // the last one used first
    std::unordered_map<Tile, std::list<Brick>::iterator, TileHash> bricks_;
    std::array<Reading, ring_size> ring_;
    std::size_t next_reading_ = 0;
    gl::Buffer writing_;
    Counters counters_;
};

}  // namespace cairn::renderer
