// Cells of the tree and of its bricks, as powers of two of finest-level voxels.
// Needs the defines TREE_N, BRICK_M and MAX_LEVEL (the tree's depth).
#if TREE_N == 4
#define N_SHIFT 2
#elif TREE_N == 2
#define N_SHIFT 1
#endif
#if BRICK_M == 8
#define M_SHIFT 3
#elif BRICK_M == 16
#define M_SHIFT 4
#elif BRICK_M == 32
#define M_SHIFT 5
#elif BRICK_M == 64
#define M_SHIFT 6
#endif

#define ROOT_SHIFT (M_SHIFT + N_SHIFT * MAX_LEVEL)
#define ROOT_SIDE (1 << ROOT_SHIFT)

// A 4^3 mask, x fastest: -1 when cell c is occupied, else log2 of the side of an empty aligned cell around it.
int empty_shift_4(uvec2 mask, ivec3 c) {
    const uint word = (c.z & 2) == 0 ? mask.x : mask.y;
    if ((word >> (c.x + 4 * c.y + 16 * (c.z & 1)) & 1u) != 0u) return -1;
    return (word >> ((c.x & 2) + 4 * (c.y & 2)) & 0x00330033u) == 0u ? 1 : 0;
}

// A 2^3 mask likewise.
int empty_shift_2(uint mask, ivec3 c) { return (mask >> (c.x + 2 * c.y + 4 * c.z) & 1u) != 0u ? -1 : 0; }
