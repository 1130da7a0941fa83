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

    /// Bit x + n (y + n z) is 0 only when child (x, y, z) of the tile is certainly empty.
    [[nodiscard]] virtual glm::uvec2 child_mask(const Tile& tile) = 0;
};

}  // namespace cairn::renderer
