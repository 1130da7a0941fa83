// How the masks of a brick lie in the pool, in 64-bit words (renderer/pool/brick_pool.h): the summary, one bit a block of
// 4^3 voxels that is not empty; then a word a block, one bit a voxel that is occupied.
#define BLOCKS_A_SIDE (BRICK_M / 4)
#define BLOCKS (BLOCKS_A_SIDE * BLOCKS_A_SIDE * BLOCKS_A_SIDE)
#define SUMMARY_WORDS ((BLOCKS + 63) / 64)
#define MASK_WORDS_A_SLOT (SUMMARY_WORDS + BLOCKS)
