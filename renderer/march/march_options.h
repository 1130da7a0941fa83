#pragma once

#include <cstdint>

namespace cairn::renderer {

/// How a ray finds its next tile (Crassin 2007, section 3.4.3; Crassin et al. 2008, section 5.1). All three
/// give the same picture, bit for bit.
enum class Traversal : std::uint8_t {
    /// The ray descends from the root for each tile.
    restart,
    /// The ray steps among the children of its node. A ray that leaves the node climbs by way of the root.
    stackless,
    /// The ray descends from the lowest of the last four nodes that holds both its old and its new place.
    mini_stack,
};

/// How rays report to the cache which tiles they miss and which bricks they use. Both give the same picture,
/// bit for bit.
enum class TileQueries : std::uint8_t {
    /// Rays list each missing tile once, and stamp every brick that they use.
    list,
    /// Each block of 16x16 pixels reports four tiles: those that its rays missed last, then the bricks that
    /// they used last (Crassin et al. 2008, section 5.3). The next pass asks again for a tile that a block
    /// left out, so a frame takes more passes; but the CPU reads less back after each.
    blocks,
};

/// The most that MarchOptions::query_capacity can be (QUERY_CAPACITY in the shaders).
constexpr int max_query_capacity = 65536;

/// How rays are marched. The picture is the same with any of these options, bit for bit.
struct MarchOptions {
    Traversal traversal = Traversal::mini_stack;
    /// Rays start at the first place where the tree may hold something, and no ray starts where the tree is
    /// certainly empty.
    bool block_starts = true;
    /// Tiles that one pass of rays can ask for, in [1, max_query_capacity]. The next pass asks again for a
    /// tile that found no room. Past the capacity, the most urgent query is kept all the same: for a brick,
    /// or else for the children of one of the deepest nodes.
    int query_capacity = max_query_capacity;
    /// How rays ask for tiles. TileQueries::blocks excludes frames within a budget and prefetching, because
    /// both need all that a frame has used.
    TileQueries tile_queries = TileQueries::list;
    bool operator==(const MarchOptions&) const = default;
};

}  // namespace cairn::renderer
