#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/march/front_cells.h"
#include "renderer/pool/tree.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/oracle.h"
#include "shaders/interop/march.h"

namespace cairn::bench {

/// What distance and frustum alone say of tiles: how deep the tree goes, by the rule that rays follow
/// (shows() in descend.glsl). For trees whose voxels a ray can count, and eyes near the root cube.
class ViewTest {
public:
    /// @throws Error (Fault::usage) when rays of the view do not start at its eye.
    ViewTest(const interop::MarchView& view, const renderer::TreeShape& shape);

    [[nodiscard]] const renderer::TreeShape& shape() const { return shape_; }
    [[nodiscard]] renderer::Box box_of(const renderer::Tile& tile) const;  ///< voxels of the finest level
    [[nodiscard]] double distance_to(const renderer::Box& box) const { return cone_.distance_to(box); }
    /// May part of the box be in the picture? By planes, as frustum culling is done.
    [[nodiscard]] bool in_frustum(const renderer::Box& box) const;
    /// Would rays that come to the tile see it by its own brick?
    [[nodiscard]] bool shows(const renderer::Tile& tile) const;
    [[nodiscard]] double voxel_side(const renderer::Tile& tile) const;  ///< in voxels of the finest level

private:
    renderer::TreeShape shape_;
    renderer::ConeOfSight cone_;
    glm::dvec3 forward_;
    glm::dvec3 across_;  // with a point at distance 1 along the view: its place in the picture, [-1, 1]
    glm::dvec3 up_;
};

/// Leaves of a tree that fits a view.
struct ViewTile {
    std::uint32_t entry = 0;
    double distance = 0.0;  ///< of its nearest point, in voxels of the finest level
};

/// Subdivides a tree which has no children yet until each tile that is in the frustum, and that the oracle
/// does not know to be empty, is as fine as the view asks for. @return those, nearest first.
/// @throws Error (Fault::usage) when the node pool is too small for them.
[[nodiscard]] std::vector<ViewTile> list_tiles(renderer::Tree& tree, renderer::Oracle& oracle,
                                               const ViewTest& test);

/// Side of a voxel, in those of the finest level, of the nearest of these tiles; none where there is none.
[[nodiscard]] std::optional<double> nearest_voxel_side(renderer::Oracle& oracle, const ViewTest& test);

}  // namespace cairn::bench
