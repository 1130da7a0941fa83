#pragma once

#include <cstdint>

namespace cairn::renderer {

/// What a shadow ray tests of a node of the xy-reduced pyramid. All find the same voxels.
enum class ColumnMask : std::uint8_t {
    mip_level,  ///< the node's cube (Forest et al. 2009, Figure 10(a)): for comparison
    adaptive,   ///< of the whole column, the voxels that the ray passes (Figure 10(b))
};

}  // namespace cairn::renderer
