#pragma once

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::bench {

/// Marks the exact voxels of a surface on all cores, without OpenGL: the time that a GPU method must beat,
/// and a second opinion on the truth. The definition is that of the voxelizer: closed triangles on the
/// lattice, closed voxels.
///
/// Each thread gets slabs of voxels with the triangles that reach them, so that marking needs no atomic
/// operation, and a slab stays in a core's cache from its clearing to its last mark.
///
/// @param bits  bits of the region's size; all of them are written.
///
/// Separating axes: Akenine-Möller 2001; row spans: Schwarz and Seidel 2010, section 3.
void mark_row_spans(const voxelizer::Surface& surface, const voxelizer::Region& region,
                    voxelizer::BitGrid& bits);

}  // namespace cairn::bench
