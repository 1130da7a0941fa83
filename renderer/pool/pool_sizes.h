#pragma once

#include <cstddef>

namespace cairn::renderer {

/// The bounds of the tree's two stores on the GPU, and of what main memory keeps beside them (Crassin et al.
/// 2008, section 4.2). In bytes.
struct PoolSizes {
    std::size_t node_bytes = std::size_t(8) << 20U;
    std::size_t brick_bytes = std::size_t(256) << 20U;
    /// Main memory for bricks that had to leave the brick pool, so that they need not be produced again; 0:
    /// such bricks are not kept.
    std::size_t cache_bytes = 0;
    bool operator==(const PoolSizes&) const = default;
};

}  // namespace cairn::renderer
