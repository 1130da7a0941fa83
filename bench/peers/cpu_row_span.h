#pragma once

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::bench {

/// The exact voxels of a surface on all cores, without OpenGL: what a GPU method must beat, and a second
/// opinion about the truth. The same definition as everywhere: closed triangles on the lattice, closed
/// voxels.
///
/// Slabs of voxels are dealt out to threads, each with the triangles that reach it, so that marking needs no
/// atomic operation and a slab stays in a core's cache from its clearing to its last mark.
///
/// @param bits  of the region's size; undefined before, all written after.
///
/// Separating axes: Akenine-Möller 2001; row spans: Schwarz and Seidel 2010, section 3.
void mark_row_spans(const voxelizer::Surface& surface, const voxelizer::Region& region,
                    voxelizer::BitGrid& bits);

}  // namespace cairn::bench
