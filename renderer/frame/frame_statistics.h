#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::renderer {

/// Counters of one `render()`.
struct FrameStatistics {
    double milliseconds = 0.0;
    std::uint64_t rays_launched =
        0;           ///< of the pixel blocks that may see anything; with a proxy, of the pixels it covers
    int passes = 0;  ///< ray-marching passes; 0 where the picture was known without any
    std::uint64_t tile_queries = 0;  ///< misses that rays reported
    std::uint64_t query_bytes = 0;   ///< read back from the GPU to know them, and what rays used
    std::uint64_t nodes_subdivided = 0;
    std::uint64_t bricks_produced = 0;
    std::uint64_t constant_tiles = 0;  ///< of those: turned out to hold one value, and keep no brick
    std::uint64_t bricks_evicted = 0;
    std::uint64_t nodes_evicted = 0;
    std::uint64_t bricks_relinked = 0;    ///< still in the pool when their node came back
    std::uint64_t bricks_cached = 0;      ///< read back into main memory when they had to leave the pool
    std::uint64_t bricks_restored = 0;    ///< taken from main memory instead of produced
    std::uint64_t bricks_prefetched = 0;  ///< produced by prefetch() since the frame before
    double march_ms = 0.0;                ///< of `milliseconds`: rays
    double produce_ms = 0.0;              ///< of `milliseconds`: subdividing, producing, uploading
    double tree_ms = 0.0;                 ///< of `produce_ms`, by render(): neither bricks nor uploading
    /// Of `produce_ms`: sending to the GPU what is made or kept in main memory: nodes, volumes' bricks, and
    /// bricks that come back from there. What the GPU makes itself is not sent.
    double upload_ms = 0.0;
    bool converged = true;  ///< nothing was missing: the picture is that of a frame without a budget
    std::uint64_t bricks_resident = 0;  ///< after the frame
    /// Of the resident bricks, those that rays read, or that were produced, since the frame began; with a
    /// budget, since the first frame of this view began.
    std::uint64_t bricks_used = 0;
    std::uint64_t brick_slots = 0;    ///< the most that can be resident
    std::size_t node_pool_bytes = 0;  ///< what the two stores take, all of it, used or not
    std::size_t brick_pool_bytes = 0;
    std::size_t brick_cache_bytes = 0;  ///< what is kept in main memory now
};

/// What a call of Renderer::prefetch_finer() came to.
struct Prefetched {
    std::uint64_t bricks = 0;  ///< produced
    bool more = false;         ///< there may be more to produce; not once the pools are full
};

}  // namespace cairn::renderer
