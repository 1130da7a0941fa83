#pragma once

#include <unordered_map>

#include "renderer/produce/oracle.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/surface.h"
#include "voxelizer/triangle_index.h"
#include "voxelizer/voxelizer.h"

namespace cairn::renderer {

/// Cuts node masks from the bitmask pyramid of a surface (Forest et al. 2009, section 2.3).
///
/// One pyramid covers the root cube; below its finest level each tile that is asked for gets a pyramid of its
/// own, voxelized from its own triangles.
class SurfaceOracle final : public Oracle {
public:
    /// Refers to all four, which must outlive it.
    SurfaceOracle(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                  voxelizer::Voxelizer& voxelizer, voxelizer::TriangleIndex& lists);

    [[nodiscard]] glm::uvec2 child_mask(const Tile& tile) override;

private:
    /// The pyramid of one tile; its finest level is `finest` (log2 of voxels across the root cube).
    struct Patch {
        voxelizer::BitmaskPyramid pyramid;
        Tile tile;
        int finest = 0;
    };
    [[nodiscard]] const Patch& patch_for(const Tile& tile);

    TreeShape shape_;
    const voxelizer::GpuSurface& surface_;
    voxelizer::Voxelizer& voxelizer_;
    voxelizer::TriangleIndex& lists_;
    std::unordered_map<Tile, Patch, TileHash> patches_;
};

}  // namespace cairn::renderer
