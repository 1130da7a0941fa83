#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/march/front_cells.h"
#include "renderer/pool/tree.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "shaders/interop/march.h"

namespace cairn::bench {

/// Decides by distance and frustum alone how deep a tree goes, by the rule that rays follow (shows() in
/// descend.glsl). For trees whose voxels a float can count, and eyes near the root cube.
class ViewTest {
public:
    /// @throws Error (Fault::usage) if rays of the view do not start at its eye.
    ViewTest(const interop::MarchView& view, const renderer::TreeShape& shape);

    [[nodiscard]] const renderer::TreeShape& shape() const { return shape_; }
    /// The tile's box in voxels of the finest level.
    [[nodiscard]] renderer::Box box_of(const renderer::Tile& tile) const;
    /// Distance from the eye, in voxels of the finest level.
    [[nodiscard]] double distance_to(const renderer::Box& box) const { return cone_.distance_to(box); }
    /// Whether a part of the box may be in the picture, by planes, as in frustum culling.
    [[nodiscard]] bool in_frustum(const renderer::Box& box) const;
    /// Whether rays that reach the tile see its own brick and not those of its children.
    [[nodiscard]] bool shows(const renderer::Tile& tile) const;
    /// Side of the tile's voxels, in voxels of the finest level.
    [[nodiscard]] double voxel_side(const renderer::Tile& tile) const;

private:
    renderer::TreeShape shape_;
    renderer::ConeOfSight cone_;
    glm::dvec3 forward_;
    // Dotted with a point at distance 1 along the view: its place in the picture, in [-1, 1].
    glm::dvec3 across_;
    glm::dvec3 up_;
};

/// A leaf of a tree that fits a view.
struct ViewTile {
    std::uint32_t entry = 0;
    double distance = 0.0;  ///< to its nearest point, in voxels of the finest level
};

/// Subdivides a tree without children until each tile that is in the frustum, and that the oracle does not
/// report as empty, is as fine as the view asks for.
/// @return these tiles, nearest first.
/// @throws Error (Fault::usage) if the node pool is too small for them.
[[nodiscard]] std::vector<ViewTile> list_tiles(renderer::Tree& tree, renderer::Oracle& oracle,
                                               const ViewTest& test);

/// Side of the voxels of the nearest such tile, in voxels of the finest level; none if there is no tile.
[[nodiscard]] std::optional<double> nearest_voxel_side(renderer::Oracle& oracle, const ViewTest& test);

}  // namespace cairn::bench
