#pragma once

#include <cstdint>

namespace cairn::renderer {

/// What rays ask of a tile.
enum class QueryKind : std::uint8_t {
    /// The node must be subdivided.
    children,
    /// The node's brick must be produced.
    brick,
    /// The node's brick could stand in for what is missing below the node. No ray waits for it.
    stand_in,
};

/// What a ray misses (Crassin et al. 2008, section 5.3).
struct TileQuery {
    std::uint32_t entry = 0;  ///< entry of the tile in the node pool
    QueryKind kind = QueryKind::children;
    std::uint32_t rays = 0;  ///< rays that ask; 0 if the pass does not count them

    bool operator==(const TileQuery&) const = default;
};

}  // namespace cairn::renderer
