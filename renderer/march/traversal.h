#pragma once

#include <cstdint>

namespace cairn::renderer {

/// How a ray finds its next tile (Crassin 2007, section 3.4.3; Crassin et al. 2008, section 5.1). All give
/// the same picture, bit for bit.
enum class Traversal : std::uint8_t {
    restart,     ///< from the root
    stackless,   ///< among the children of its node; a ray that leaves it climbs by way of the root
    mini_stack,  ///< from the lowest node, of the last four, that holds where it was and where it is
};

}  // namespace cairn::renderer
