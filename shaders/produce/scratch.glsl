// What the producer gathers for each voxel of the batch, border included, before it is packed into the pool.
// Sums are whole numbers, so the order of the threads does not show in the brick.
#include "interop/config.h"
#include "interop/bindings.h"
#include "interop/types.h"

#define SIDE (BRICK_M + 2)           // voxels a side, border included
#define VOXELS (SIDE * SIDE * SIDE)

// Two arrays, so that empty voxels, which are most, cost their masks alone.
//     masks      2 words a voxel: 4^3 finer voxels, bit x + 4 (y + 4 z)
//     sums       SUM_WORDS a voxel, from word `sums_offset` on
#define SUM_WEIGHT 0               // finer voxels, counted for each triangle
#define SUM_NORMAL 1               // 3 words: weighted normals, NORMAL_UNIT = 1
#define SUM_COLOR 4                // 3 words: weighted linear colours, COLOR_UNIT = 1
#if HAS_COLOR
#define SUM_WORDS 7
#else
#define SUM_WORDS 4
#endif
#define NORMAL_UNIT 511.0
#define COLOR_UNIT 1023.0
#define WEIGHT_LIMIT 1048576u      // more would overflow the sums: triangles that come later, in the threads' order, are left out

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { BrickTile tiles[]; };
layout(std430, binding = SSBO_BRICK_SCRATCH) buffer ScratchBlock { uint scratch[]; };

uniform uint sums_offset;

// Number of a voxel in the batch; v in [0, SIDE), border included.
uint scratch_voxel(uint tile, ivec3 v) { return tile * uint(VOXELS) + uint(v.x + SIDE * (v.y + SIDE * v.z)); }
