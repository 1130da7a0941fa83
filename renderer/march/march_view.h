#pragma once

#include "renderer/march/windows.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/view/view.h"
#include "shaders/interop/march.h"
#include "voxelizer/grid.h"

/// From a view in the world to what rays are told of it.
namespace cairn::renderer {

/// Where a point of the view is in the tree. Unanchored ones are told from the root cube.
[[nodiscard]] Place place_of(const View& view, const glm::dvec3& point, const voxelizer::Grid& grid);

/// All but the surface's colour and the band. @param coarsest  the window whose voxels lengths are told in;
/// null: the root cube's.
/// @throws Error (Fault::usage) when floats cannot tell where the camera or the light is.
[[nodiscard]] interop::MarchView march_view(const View& view, const voxelizer::Grid& grid,
                                            const TreeShape& shape, const Window* coarsest);

/// Likewise for voxels of one size, without a tree: the view has no anchor, and a ray's cone is as wide as
/// its pixel.
[[nodiscard]] interop::MarchView march_view(const View& view, const voxelizer::Grid& grid);

}  // namespace cairn::renderer
