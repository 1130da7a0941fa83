#pragma once

#include <cstddef>
#include <cstdint>

namespace cairn::renderer {

/// Counters of one frame.
struct FrameStatistics {
    /// The whole frame.
    double milliseconds = 0.0;
    /// Rays of the pixel blocks that may see anything; with a proxy, rays of the pixels that it covers. Rays
    /// of a part that was given up (FrameLoop::run_parts()) are launched again.
    std::uint64_t rays_launched = 0;
    /// Ray-marching passes; 0 if the picture was kept, or if no block of pixels may see anything.
    int passes = 0;
    std::uint64_t tile_queries = 0;  ///< misses that rays reported
    /// Bytes read back from the GPU: tile queries, and which bricks rays used.
    std::uint64_t query_bytes = 0;
    std::uint64_t nodes_subdivided = 0;
    std::uint64_t bricks_produced = 0;
    /// Produced tiles that turned out to hold one value, and keep no brick.
    std::uint64_t constant_tiles = 0;
    std::uint64_t bricks_evicted = 0;
    std::uint64_t nodes_evicted = 0;
    /// Bricks that were still in the pool when their node came back.
    std::uint64_t bricks_relinked = 0;
    /// Bricks read back into main memory when they had to leave the pool.
    std::uint64_t bricks_cached = 0;
    /// Bricks taken from main memory instead of produced.
    std::uint64_t bricks_restored = 0;
    /// Bricks produced by prefetching since the frame before.
    std::uint64_t bricks_prefetched = 0;
    /// Part of `milliseconds`: marching rays.
    double march_ms = 0.0;
    /// Part of `milliseconds`: subdividing, producing and uploading.
    double produce_ms = 0.0;
    /// Part of `produce_ms`, in frames without a budget: the tree, without bricks and uploading.
    double tree_ms = 0.0;
    /// Part of `produce_ms`: sending to the GPU what main memory makes or keeps (nodes, bricks of volumes,
    /// bricks that come back from main memory). What the GPU makes itself is not sent.
    double upload_ms = 0.0;
    /// Nothing was missing: the picture is that of a frame without a budget.
    bool converged = true;
    std::uint64_t bricks_resident = 0;  ///< bricks in the pool after the frame
    /// Resident bricks that rays read, or that were produced, since the frame began; with a budget, since the
    /// first frame of this view began; with several samples per pixel, since the last of them began.
    std::uint64_t bricks_used = 0;
    /// The most bricks that can be resident; packed bricks fill the pool's bytes before.
    std::uint64_t brick_slots = 0;
    std::size_t node_pool_bytes = 0;       ///< size of the node pool, used or not
    std::size_t brick_pool_bytes = 0;      ///< size of the brick pool, used or not
    std::size_t brick_bytes_resident = 0;  ///< what the bricks in the pool take of it
    std::size_t brick_cache_bytes = 0;     ///< size of the bricks in main memory now
};

/// Result of Renderer::prefetch_finer().
struct PrefetchResult {
    std::uint64_t bricks = 0;  ///< bricks produced
    bool more = false;         ///< there may be more to produce; false once the pools are full
};

}  // namespace cairn::renderer
