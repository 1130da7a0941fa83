#pragma once

#include "renderer/march/windows.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/view/view.h"
#include "shaders/interop/march.h"
#include "voxelizer/grid.h"

/// From a view in the world to the view that shaders read.
namespace cairn::renderer {

/// Where a point of the view is in the tree: in the tile of the view's anchor, or in the root if the view has
/// no anchor.
[[nodiscard]] TilePoint tile_point(const View& view, const glm::dvec3& point, const voxelizer::Grid& grid);

/// Fills all of the MarchView but the surface's colour and the band.
/// @param coarsest  the coarsest window, whose voxels are the unit of lengths; null: voxels of the finest
///                  level are the unit.
/// @throws Error (Fault::usage) if floats cannot hold where the camera or the light is.
[[nodiscard]] interop::MarchView march_view(const View& view, const voxelizer::Grid& grid,
                                            const TreeShape& shape, const Window* coarsest);

/// The same for voxels of one size, without a tree: the view must have no anchor, and the cone of a ray is as
/// wide as its pixel.
[[nodiscard]] interop::MarchView march_view(const View& view, const voxelizer::Grid& grid);

}  // namespace cairn::renderer
