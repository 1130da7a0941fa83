// The sums that the producer gathers per voxel of the batch, border included, before they are packed into the
// pool. Sums are whole numbers, so the order of the threads does not affect the brick.
#include "interop/produce.h"
#include "pool/brick_levels.glsl"

// Every mip of a brick is gathered from the triangles, as if it were a brick by itself. So it equals, bit for
// bit, the same part of the parent's brick and of its neighbours' borders.
#define MIP_SIDE(mip) (MIP_M(mip) + 2)  // voxels per side, border included
#define MIP_VOXELS(mip) CUBE(MIP_SIDE(mip))
#define VOXELS                                                                                            \
    (MIP_VOXELS(0) + (BRICK_MIPS >= 1 ? MIP_VOXELS(1) : 0) + (BRICK_MIPS >= 2 ? MIP_VOXELS(2) : 0) + \
     (BRICK_MIPS >= 3 ? MIP_VOXELS(3) : 0))

// There are two arrays, so that empty voxels, which are the most, cost only their masks.
//     masks      2 words per voxel, mip after mip: 4^3 finer voxels, bit x + 4 (y + 4 z)
//     sums       SUM_WORDS per voxel, from word `sums_offset` on
// Area of the surface, in faces of a finer voxel, summed over the triangles; WEIGHT_UNIT = 1.
#define SUM_WEIGHT 0
#define SUM_NORMAL 1               // 3 words: weighted normals, NORMAL_UNIT = 1
// 5 words: products of the normals' components, xx, xy, xz, yy, yz, weighted alike.
#define SUM_MOMENTS 4
#define SUM_COLOR 9                // 3 words: weighted linear colours, COLOR_UNIT = 1
// Then, in place of the normals' sums: the voxel's normals (pool/brick_normals.glsl), and how far its slab reaches
// (pool/slab.glsl).
#define PACKED_NORMALS SUM_NORMAL
#define SLAB_REACH (SUM_NORMAL + 1)
#if HAS_COLOR
#define SUM_WORDS 12
#else
#define SUM_WORDS 9
#endif
#define WEIGHT_UNIT 256.0
#define NORMAL_UNIT 255.0
#define COLOR_UNIT 1023.0
// A greater weight would overflow the sums: once it is passed, further triangles, in the order of the
// threads, are left out.
#define WEIGHT_LIMIT 2097152u

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { BrickTile tiles[]; };
layout(std430, binding = SSBO_BRICK_SCRATCH) buffer ScratchBlock { uint scratch[]; };

uniform uint sums_offset;

// Number of a mip's first voxel among the voxels of its tile.
int first_voxel_of(int mip) {
    int first = 0;
    for (int k = 0; k < mip; ++k) first += MIP_VOXELS(k);
    return first;
}

// Number of a voxel in the batch; v in [0, MIP_SIDE(mip)), border included.
uint scratch_voxel(uint tile, int mip, ivec3 v) {
    const int side = MIP_SIDE(mip);
    return tile * uint(VOXELS) + uint(first_voxel_of(mip) + v.x + side * (v.y + side * v.z));
}
