#pragma once

#include <cstdint>

namespace cairn::renderer {

/// How rays tell the cache what they miss and what they used. The picture is the same, bit for bit.
enum class TileQueries : std::uint8_t {
    /// Each missing tile once, and a stamp for every brick that was used.
    list,
    /// Each block of 16x16 pixels tells of four tiles: of those that its rays missed last, then of bricks
    /// that they used last (Crassin et al. 2008, section 5.3). What is not told is asked for again, so it
    /// takes more passes; but less is read back in each.
    blocks,
};

}  // namespace cairn::renderer
