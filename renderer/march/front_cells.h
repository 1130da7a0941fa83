#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "renderer/pool/tree.h"
#include "shaders/interop/pool.h"

namespace cairn::renderer {

/// A box in the root cube, in voxels of the finest level.
struct Box {
    glm::dvec3 low{0.0};
    glm::dvec3 high{0.0};
};

/// How far rays from an eye go down the tree (shows() in descend.glsl).
struct ConeOfSight {
    glm::dvec3 eye{0.0};
    double width = 0.0;  ///< width of a pixel's cone at distance 1
    /// Rays see mips of a brick too, and may see parts of one tile by different mips.
    bool is_blended = false;

    /// Distance to the nearest point of the box.
    [[nodiscard]] double distance_to(const Box& box) const {
        return glm::length(glm::max(glm::max(box.low - eye, eye - box.high), glm::dvec3(0.0)));
    }
    /// Distance to the farthest corner of the box.
    [[nodiscard]] double distance_past(const Box& box) const {
        return glm::length(glm::max(glm::abs(box.low - eye), glm::abs(box.high - eye)));
    }
};

/// Calls add(Box) for cells that together hold everything that is not empty, according to the CPU mirror of
/// the tree. A cell is a child, not empty, of a tile that rays show, or of a tile that has no children yet.
/// Tiles for which see(Box) is false are left out.
///
/// A cell that is empty here is empty at coarser levels too: the voxels of a brick are never larger than the
/// children of its tile. The voxels of its coarsest mip may be larger; then the whole tile is one cell.
template <typename See, typename Add>
class FrontCells {
public:
    FrontCells(const Tree& tree, const ConeOfSight& cone, See see, Add add)
        : tree_(tree), shape_(tree.shape()), cone_(cone), see_(see), add_(add) {}

    void walk(std::uint32_t entry = 0) {
        const interop::NodeEntry& node = tree_.node(entry);
        const Tile& tile = tree_.tile(entry);
        const Box box = box_of(tile);
        if (!see_(box)) return;
        const double voxel_side = (box.high.x - box.low.x) / shape_.m;
        // If rounding decides, the walk goes down: that leaves nothing out.
        const bool goes_down =
            tile.level < shape_.max_level && voxel_side > 0.999 * cone_.width * cone_.distance_to(box);
        // With blending, rays may see the near end of a tile by its children and the far end by itself.
        const bool shows_itself =
            !goes_down || (cone_.is_blended && voxel_side < 1.001 * cone_.width * cone_.distance_past(box));
        const bool holds_mips = !cone_.is_blended || shape_.n * shape_.n <= shape_.m;
        const bool has_child_mask = (node.child_mask.x | node.child_mask.y) != 0;
        // A tile without its brick is asked for, or replaced by an ancestor, as a whole. A final tile is
        // shown as a whole.
        const bool has_brick = (node.brick & NODE_SLOT) != 0;
        if ((node.brick & NODE_FINAL) != 0 ||
            (shows_itself && (!has_brick || !has_child_mask || !holds_mips))) {
            add_(box);
            return;
        }
        for (int child = 0; child < shape_.child_count(); ++child) {
            if (!may_hold(node.child_mask, shape_.n, child)) continue;
            if (!shows_itself && node.children != 0)
                walk(node.children + std::uint32_t(child));
            else
                add_(box_of(child_of(tile, shape_.n, child)));
        }
    }

private:
    [[nodiscard]] Box box_of(const Tile& tile) const {
        const double side = double(shape_.resolution()) / std::pow(double(shape_.n), tile.level);
        const glm::dvec3 low = glm::dvec3(tile.position) * side;
        return {low, low + side};
    }

    const Tree& tree_;
    TreeShape shape_;
    ConeOfSight cone_;
    See see_;
    Add add_;
};

}  // namespace cairn::renderer
