// How the masks of a brick lie in the pool, in 64-bit words (renderer/pool/brick_pool.h): the summary, one bit a block
// of voxels that is not empty; then a word a block, one bit a voxel that is occupied. Blocks are 4^3 voxels, x fastest; 3^3
// where M is a power of 3, in the low 27 bits.
#if BRICK_M % 3 == 0
#define BLOCK_SIDE 3
#else
#define BLOCK_SIDE 4
#endif
#define BLOCKS_A_SIDE (BRICK_M / BLOCK_SIDE)
#define BLOCKS (BLOCKS_A_SIDE * BLOCKS_A_SIDE * BLOCKS_A_SIDE)
#define SUMMARY_WORDS ((BLOCKS + 63) / 64)
#define MASK_WORDS_A_SLOT (SUMMARY_WORDS + BLOCKS)
