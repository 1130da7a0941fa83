#pragma once

#include "renderer/march/tile_queries.h"
#include "renderer/march/traversal.h"

namespace cairn::renderer {

/// The most that MarchOptions::query_capacity can be (QUERY_CAPACITY in the shaders).
constexpr int max_query_capacity = 65536;

/// How rays are marched. The picture is the same with any of these, bit for bit.
struct MarchOptions {
    Traversal traversal = Traversal::mini_stack;
    /// Rays start where the tree says that there may be something, and no ray starts where there is nothing.
    bool block_starts = true;
    /// Tiles that one pass of rays can ask for, [1, max_query_capacity]; the rest is asked for again by the
    /// next pass. Where more tiles are asked for, the most urgent is known all the same: a brick, or else the
    /// children of a node as deep as any.
    int query_capacity = max_query_capacity;
    /// How rays ask for tiles. With blocks there are neither frames within a budget nor prefetching, which
    /// must know all that a frame has used.
    TileQueries tile_queries = TileQueries::list;
    bool operator==(const MarchOptions&) const = default;
};

}  // namespace cairn::renderer
