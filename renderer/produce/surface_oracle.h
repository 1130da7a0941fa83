#pragma once

#include <unordered_map>

#include "renderer/produce/content.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::renderer {

/// For maps keyed by cells.
struct CellHash {
    [[nodiscard]] std::size_t operator()(const voxelizer::Cell& cell) const {
        return TileHash{}({cell.level, cell.position});
    }
};

/// Cuts node masks from the bitmask pyramid of a surface (Forest et al. 2009, section 2.3).
///
/// One pyramid covers the root cube. Below its finest level, each of its cells that is asked for gets a
/// pyramid of its own, voxelized from the cell's triangles. If N is a power of two, tiles are cells of a
/// pyramid, and the masks are exact. With N = 3, a tile counts as empty if all cells that meet it are empty,
/// down to cells of a quarter of its side or smaller.
class SurfaceOracle final : public Oracle {
public:
    /// Refers to all three, which must outlive it.
    SurfaceOracle(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                  voxelizer::Voxelizer& voxelizer, voxelizer::TriangleIndex& lists);

    [[nodiscard]] glm::uvec2 child_mask(const Tile& tile) override;
    [[nodiscard]] bool is_empty(const Tile& tile) override;

private:
    /// The pyramid of one cell; its finest level is `finest` (log2 of cells across the lattice's root cube).
    struct Patch {
        voxelizer::BitmaskPyramid pyramid;
        voxelizer::Cell cell;
        int finest = 0;

        [[nodiscard]] bool at(const voxelizer::Cell& c) const {
            return pyramid.level(finest - c.level).at(c.position - (cell.position << (c.level - cell.level)));
        }
    };
    /// A closed box in lattice units.
    struct Box {
        glm::ivec3 low, high;
    };
    /// The patch that covers a cell. It stays until drop_if_too_many().
    [[nodiscard]] const Patch& patch_for(const voxelizer::Cell& cell);
    void drop_if_too_many();
    /// May the surface meet the part of a cell that lies in the box? Cells of level `finest` decide.
    [[nodiscard]] bool may_meet(const Box& box, const voxelizer::Cell& cell, int finest);
    [[nodiscard]] bool may_meet(const Tile& tile);

    TreeShape shape_;
    const voxelizer::GpuSurface& surface_;
    voxelizer::Voxelizer& voxelizer_;
    voxelizer::TriangleIndex& lists_;
    int list_step_;      ///< levels from a cell that has a list to the next
    int finest_needed_;  ///< level of the smallest cells that are needed
    std::unordered_map<voxelizer::Cell, Patch, CellHash> patches_;
};

}  // namespace cairn::renderer
