#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/content.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// A point in the tree, relative to a tile: exact however small the tile is.
struct TilePoint {
    Tile tile;
    /// From the low corner of the tile, in units of its side; may lie outside the tile.
    glm::dvec3 offset{0.0};
};

/// The 2^3 tiles of one level that are nearest to the eye (see shaders/march/windows.glsl). Some may lie
/// outside the root cube.
struct Window {
    int level = 0;
    glm::i64vec3 low{0};  ///< the tile at the window's low corner
};

/// The windows around the eye, from the finest that rays can use to the one that holds the root. Each window
/// lies in the next. The eye lies in all of them, unless it is further away than the side of the root cube:
/// then there is only the last window.
[[nodiscard]] std::vector<Window> windows_around(const TreeShape& shape, const TilePoint& eye);

/// Leaves out the empty windows around the eye, which rays do not need. Asks the oracle and not the tree,
/// because the tree's answer would depend on what it holds.
void drop_empty(std::vector<Window>& windows, const TreeShape& shape, Oracle& oracle);

/// Where a point is in a window: from the window's low corner, in voxels of the level that is
/// `levels_in_window()` below the window's tiles.
[[nodiscard]] glm::dvec3 point_in_window(const Window& window, const TreeShape& shape,
                                         const TilePoint& place);

/// The windows as shaders read them, except MarchWindow::tiles, which find_tiles() fills.
/// @param light  position of the light; null if the light is directional.
/// @param towards  direction to a directional light.
[[nodiscard]] std::vector<interop::MarchWindow> make_ray_windows(const std::vector<Window>& windows,
                                                                 const TreeShape& shape, const TilePoint& eye,
                                                                 const TilePoint* light,
                                                                 const glm::dvec3& towards);

/// Fills MarchWindow::tiles: finds the tiles of the windows in the tree.
/// @param subdivide  called with the entry of a tile that has no children but should; may give it children.
void find_tiles(const std::vector<Window>& windows, const Tree& tree,
                std::vector<interop::MarchWindow>& ray_windows,
                const std::function<void(std::uint32_t)>& subdivide = {});

}  // namespace cairn::renderer
