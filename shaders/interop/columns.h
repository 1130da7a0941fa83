// The xy-reduced pyramid (renderer/shadow/column_pyramid.h) and the shadow rays that go through it.
#ifndef CAIRN_INTEROP_COLUMNS_H
#define CAIRN_INTEROP_COLUMNS_H

// Beside UBO_VIEW, SSBO_PICTURE, SSBO_SHADOW_SUMS and TEXTURE_MESH_*.
#define SSBO_COLUMN_COUNTS 2  // number of pixels whose rays go on in the next pass
#define SSBO_COLUMNS 0        // texels of the coarser level that is being built
#define TEXTURE_COLUMNS 0     // all levels, COLUMN_TEXEL_BITS per texel

// Bits of a column that one fetch reads.
#define COLUMN_TEXEL_BITS 128
// The bits of a column that are tested: enum ColumnMask of renderer/shadow/shadow_base.h.
#define COLUMN_MASK_MIP_LEVEL 0
#define COLUMN_MASK_ADAPTIVE 1
// Limits of log2 of the voxels per side. A ray turns its loops fewer than 12 times per voxel of a side. These
// turns come on top of TURN_BUDGET, and together they must stay under the limit of llvmpipe
// (VOXEL_REGION_SIDE).
#define COLUMN_LEAST_LEVELS 3
#define COLUMN_MOST_LEVELS 11

#endif
