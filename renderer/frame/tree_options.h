#pragma once

#include <cstddef>
#include <optional>

#include "renderer/march/tile_queries.h"
#include "renderer/march/traversal.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The shape of the N^3-tree and the bounds of its caches (Crassin et al. 2008, section 4).
struct TreeOptions {
    int n = 4;   ///< children an axis: 2, 3, 4 or 8
    int m = 16;  ///< voxels of a brick an axis, without the border: 8, 16, 32 or 64; 27 or 81 with n = 3
    int max_resolution = 8192;  ///< voxels across the root cube that rays may ask for
    bool mips = false;  ///< bricks hold mip levels, for LevelOfDetail::blended; a fifth more memory. Of
                        ///< surfaces, not with n = 3
    /// Levels under the root, instead of max_resolution: for contents without a finest level. The finest
    /// voxels are at least 2^-60 of the root cube.
    std::optional<int> max_level = std::nullopt;
    std::size_t node_pool_bytes = 8U << 20U;
    std::size_t brick_pool_bytes = 256U << 20U;
    Traversal traversal = Traversal::mini_stack;
    /// Rays start where the tree says that there may be something, and none is made where there is nothing.
    /// The picture is the same without it, only slower.
    bool block_starts = true;
    /// Main memory for bricks that had to leave the pool, so that they need not be produced again; 0: none.
    std::size_t brick_cache_bytes = 0;
    /// Tiles that one pass of rays can ask for, [1, 65536]; the rest is asked for again by the next pass.
    int query_capacity = 65536;
    /// How rays ask for them. With blocks there are neither frames within a budget nor prefetching, which
    /// must know all that a frame has used.
    TileQueries tile_queries = TileQueries::list;
};

/// @throws Error (Fault::usage) for a shape that cannot work.
[[nodiscard]] TreeShape tree_shape_of(const TreeOptions& options);

}  // namespace cairn::renderer
