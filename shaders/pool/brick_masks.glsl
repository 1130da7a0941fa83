// How the masks of a brick lie in the pool, in 64-bit words (renderer/pool/brick_pool.h): the summary, one
// bit a block of voxels in which a voxel of any mip is occupied; then, for each mip, a word a block, one bit
// a voxel that is occupied. Blocks are 4^3 voxels, x fastest; 3^3 where M is a power of 3, in the low 27
// bits.
// Needs the defines of TreeShape::defines(): BLOCK_SIDE; BLOCKS, of mip 0; SUMMARY_WORDS and MASK_WORDS, per
// slot.
#include "pool/brick_levels.glsl"

#define BLOCKS_PER_SIDE (BRICK_M / BLOCK_SIDE)
#define MIP_BLOCKS_PER_SIDE(mip) max(MIP_M(mip) / BLOCK_SIDE, 1)
#define MIP_BLOCKS(mip) CUBE(MIP_BLOCKS_PER_SIDE(mip))

// Word of a slot at which the masks of a mip start.
int first_mask_of(int mip) {
    int first = SUMMARY_WORDS;
    for (int k = 0; k < mip; ++k) first += MIP_BLOCKS(k);
    return first;
}
