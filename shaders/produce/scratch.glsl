// What the producer gathers for each voxel of the batch, border included, before it is packed into the pool.
// Sums are whole numbers, so the order of the threads does not show in the brick.
#include "interop/config.h"
#include "interop/bindings.h"
#include "interop/types.h"

#define SIDE (BRICK_M + 2)           // voxels a side, border included
#define VOXELS (SIDE * SIDE * SIDE)

#define SCRATCH_MASK 0               // 2 words: 4^3 finer voxels, bit x + 4 (y + 4 z)
#define SCRATCH_WEIGHT 2             // finer voxels, counted for each triangle
#define SCRATCH_NORMAL 3             // 3 words: weighted normals, SCRATCH_NORMAL_UNIT = 1
#define SCRATCH_COLOR 6              // 3 words: weighted linear colours, SCRATCH_COLOR_UNIT = 1
#if HAS_COLOR
#define SCRATCH_WORDS 9
#else
#define SCRATCH_WORDS 6
#endif
#define SCRATCH_NORMAL_UNIT 511.0
#define SCRATCH_COLOR_UNIT 1023.0
#define SCRATCH_WEIGHT_LIMIT 1048576u  // more would overflow the sums: what comes later no longer changes the mean

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { BrickTile tiles[]; };
layout(std430, binding = SSBO_BRICK_SCRATCH) buffer ScratchBlock { uint scratch[]; };

// First scratch word of a voxel; v in [0, SIDE), border included.
uint scratch_word(uint tile, ivec3 v) {
    return (tile * uint(VOXELS) + uint(v.x + SIDE * (v.y + SIDE * v.z))) * uint(SCRATCH_WORDS);
}
