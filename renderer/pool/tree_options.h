#pragma once

#include <optional>

#include "renderer/pool/tree_shape.h"

namespace cairn::renderer {

/// The shape of the N^3-tree that a content is made for (Crassin et al. 2008, section 4).
struct TreeOptions {
    /// Children of a node per axis: 2, 3, 4 or 8.
    int n = 4;
    /// Voxels of a brick per axis, without the border: 8, 16, 32 or 64; 27 or 81 with n = 3.
    int m = 16;
    /// Voxels across the root cube that rays may ask for.
    int max_resolution = 8192;
    /// Bricks hold mip levels, for LevelOfDetail::Kind::blended, and take a fifth more memory. Of surfaces
    /// alone, and not with n = 3.
    bool mips = false;
    /// Levels under the root, instead of max_resolution: for contents without a finest level. The finest
    /// voxels are at least 2^-60 of the root cube.
    std::optional<int> max_level = std::nullopt;
    bool operator==(const TreeOptions&) const = default;
};

/// @throws Error (Fault::usage) for a shape that cannot work.
[[nodiscard]] TreeShape tree_shape_of(const TreeOptions& options);

}  // namespace cairn::renderer
