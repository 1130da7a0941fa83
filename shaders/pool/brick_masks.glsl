// How the masks of a brick lie in the pool, in 64-bit words (renderer/pool/brick_pool.h): the summary, one bit a block
// of voxels in which a voxel of any mip is occupied; then, for each mip, a word a block, one bit a voxel that is occupied.
// Blocks are 4^3 voxels, x fastest; 3^3 where M is a power of 3, in the low 27 bits.
#include "pool/brick_levels.glsl"

#if BRICK_M % 3 == 0
#define BLOCK_SIDE 3
#else
#define BLOCK_SIDE 4
#endif
#define BLOCKS_A_SIDE (BRICK_M / BLOCK_SIDE)
#define BLOCKS (BLOCKS_A_SIDE * BLOCKS_A_SIDE * BLOCKS_A_SIDE)
#define SUMMARY_WORDS ((BLOCKS + 63) / 64)
#define MIP_BLOCKS_A_SIDE(mip) max(MIP_M(mip) / BLOCK_SIDE, 1)
#define MIP_BLOCKS(mip) CUBE(MIP_BLOCKS_A_SIDE(mip))
#define MASK_WORDS_A_SLOT                                                                              \
    (SUMMARY_WORDS + BLOCKS + (BRICK_MIPS >= 1 ? MIP_BLOCKS(1) : 0) + (BRICK_MIPS >= 2 ? MIP_BLOCKS(2) : 0) + \
     (BRICK_MIPS >= 3 ? MIP_BLOCKS(3) : 0))

// Word of a slot at which the masks of a mip start.
int first_mask_of(int mip) {
    int first = SUMMARY_WORDS;
    for (int k = 0; k < mip; ++k) first += MIP_BLOCKS(k);
    return first;
}
