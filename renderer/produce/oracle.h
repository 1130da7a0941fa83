#pragma once

#include <glm/glm.hpp>

#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// Says, without producing anything, which tiles are empty (Crassin et al. 2008, section 6.2).
class Oracle {
public:
    Oracle() = default;
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;
    Oracle(Oracle&&) = delete;
    Oracle& operator=(Oracle&&) = delete;
    virtual ~Oracle() = default;

    /// As in NodeEntry. Bit x + n (y + n z) is 0 only when child (x, y, z) of the tile is certainly empty;
    /// with n = 8, bit x + 4 (y + 4 z) only when the group of 2^3 children from (2 x, 2 y, 2 z) on is.
    [[nodiscard]] virtual glm::uvec2 child_mask(const Tile& tile) = 0;

    /// Is the tile certainly empty, at every level? Asked where a child mask does not tell it of one tile
    /// alone (n = 8).
    [[nodiscard]] virtual bool is_empty(const Tile& tile) {
        (void)tile;
        return false;
    }
};

}  // namespace cairn::renderer
