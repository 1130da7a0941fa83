#pragma once

#include <cstdint>

namespace cairn::renderer {

/// What a tile is asked for.
enum class QueryKind : std::uint8_t {
    children,  ///< the node must be subdivided
    brick,     ///< the node's brick must be produced
    stand_in,  ///< the node's brick could stand in for what is missing below it; no ray waits for it
};

/// What a ray misses (Crassin et al. 2008, section 5.3).
struct TileQuery {
    std::uint32_t entry = 0;  ///< the tile's, in the node pool
    QueryKind kind = QueryKind::children;
    std::uint32_t rays = 0;  ///< that ask for it; 0 where nobody counted

    bool operator==(const TileQuery&) const = default;
};

}  // namespace cairn::renderer
