#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/pool/tree.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/oracle.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

/// A place told exactly, however small the part of the root cube that it is about.
struct Place {
    Tile tile;
    glm::dvec3 offset{0.0};  ///< from the tile's low corner, in its sides; may lie outside the tile
};

/// The 2^3 tiles of one level that are nearest to the eye (see shaders/march/windows.glsl). Some may lie
/// outside the root cube.
struct Window {
    int level = 0;
    glm::i64vec3 low{0};  ///< its first tile
};

/// From the finest that rays can use to the one that holds the root. Each lies in the next, and the eye in
/// each, unless it is further than a root cube's side away: then there is only the last.
[[nodiscard]] std::vector<Window> windows_around(const TreeShape& shape, const Place& eye);

/// Leaves out the windows around the eye that are empty, of which rays need know nothing. Asks the oracle and
/// not the tree, whose answer would depend on what it holds.
void drop_empty(std::vector<Window>& windows, const TreeShape& shape, Oracle& oracle);

/// Where a place is in a window: in voxels `levels_in_window()` finer than its tiles, from its low corner.
[[nodiscard]] glm::dvec3 place_in(const Window& window, const TreeShape& shape, const Place& place);

/// What rays are to know of the windows, without `tiles`.
/// @param light  its place, or nothing where it is a direction: then `towards` is.
[[nodiscard]] std::vector<interop::MarchWindow> march_windows(const std::vector<Window>& windows,
                                                              const TreeShape& shape, const Place& eye,
                                                              const Place* light, const glm::dvec3& towards);

/// Finds the windows' tiles in the tree, for `tiles`.
/// @param subdivide  called with the entry of a tile that has no children but should; may give it some.
void find_tiles(const std::vector<Window>& windows, const Tree& tree,
                std::vector<interop::MarchWindow>& marched,
                const std::function<void(std::uint32_t)>& subdivide = {});

}  // namespace cairn::renderer
