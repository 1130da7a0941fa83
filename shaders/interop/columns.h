// The xy-reduced pyramid (renderer/shadow/column_pyramid.h) and the shadow rays that go through it.
#ifndef CAIRN_INTEROP_COLUMNS_H
#define CAIRN_INTEROP_COLUMNS_H

// Beside UBO_VIEW, SSBO_PICTURE, SSBO_SHADOW_SUMS and TEXTURE_MESH_*.
#define SSBO_COLUMN_COUNTS 2  // pixels whose rays go on in the next pass
#define SSBO_COLUMNS 0        // texels of a coarser level, when it is built
#define TEXTURE_COLUMNS 0     // all levels, COLUMN_TEXEL_BITS per texel

// Bits of a column that one fetch reads, and what is tested of a column: enum ColumnMask of
// renderer/shadow/column_mask.h.
#define COLUMN_TEXEL_BITS 128
#define COLUMN_MASK_MIP_LEVEL 0
#define COLUMN_MASK_ADAPTIVE 1
// Log2 of voxels per side. A ray turns its loops fewer than 12 times for each, which past TURN_BUDGET must
// stay under the turns that llvmpipe grants (VOXEL_REGION_SIDE).
#define COLUMN_LEAST_LEVELS 3
#define COLUMN_MOST_LEVELS 11

#endif
