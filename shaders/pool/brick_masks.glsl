// The masks of a brick in the pool, in 64-bit words (renderer/pool/brick_pool.h). First the summary, with one
// bit per block of voxels: whether a voxel of any mip is occupied in it. Then, for each mip, one word per
// block, with one bit per voxel: whether it is occupied. Blocks are 4^3 voxels, x fastest; if M is a power of
// 3, they are 3^3 voxels, in the low 27 bits.
// Needs the defines of TreeShape::defines(): BLOCK_SIDE; BLOCKS, of mip 0; SUMMARY_WORDS and MASK_WORDS, per
// slot.
#include "pool/brick_levels.glsl"

#define BLOCKS_PER_SIDE (BRICK_M / BLOCK_SIDE)
#define MIP_BLOCKS_PER_SIDE(mip) max(MIP_M(mip) / BLOCK_SIDE, 1)
#define MIP_BLOCKS(mip) CUBE(MIP_BLOCKS_PER_SIDE(mip))

// Number in a slot of the first mask word of a mip.
int first_mask_of(int mip) {
    int first = SUMMARY_WORDS;
    for (int k = 0; k < mip; ++k) first += MIP_BLOCKS(k);
    return first;
}
