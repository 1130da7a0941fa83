// Cells of the tree and of its bricks: aligned cubes whose sides are powers of CELL_BASE in finest-level voxels. A power is
// called a shift, because with CELL_BASE 2 it is one.
// Needs the defines TREE_N, BRICK_M and MAX_LEVEL (the tree's depth).
#define CELL_BASE 2
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
// A block is the cube of voxels that one word of a brick's masks tells of.
#define BLOCK_SHIFT 2

#define ROOT_SHIFT (M_SHIFT + N_SHIFT * MAX_LEVEL)
#define ROOT_SIDE (1 << ROOT_SHIFT)

// Rays go through windows of 2^3 cubes from which descents start (windows.glsl), or there is one cube, the root.
#ifndef WINDOWS
#define WINDOWS 0
#endif
#if WINDOWS
#define MARCHED_SIDE (2 * ROOT_SIDE)
#else
#define MARCHED_SIDE ROOT_SIDE
#endif

int cell_side(int shift) { return 1 << shift; }
// Number of the cell of that size that a voxel is in, along each axis.
ivec3 cell_of(ivec3 voxel, int shift) { return voxel >> shift; }
bool same_cell(ivec3 a, ivec3 b, int shift) {
    const ivec3 differ = a ^ b;
    return (differ.x | differ.y | differ.z) >> min(shift, 31) == 0;
}
// The first voxel of that cell.
ivec3 cell_low(ivec3 voxel, int shift) { return (voxel >> shift) << shift; }
// Place of that cell in the cell that is `up` powers larger.
ivec3 place_in(ivec3 voxel, int shift, int up) { return (voxel >> shift) & ((1 << up) - 1); }

// A 4^3 mask, x fastest: -1 when cell c is occupied, else log2 of the side of an empty aligned cell around it.
int empty_shift_4(uvec2 mask, ivec3 c) {
    const uint word = (c.z & 2) == 0 ? mask.x : mask.y;
    if ((word >> (c.x + 4 * c.y + 16 * (c.z & 1)) & 1u) != 0u) return -1;
    return (word >> ((c.x & 2) + 4 * (c.y & 2)) & 0x00330033u) == 0u ? 1 : 0;
}

// A 2^3 mask likewise.
int empty_shift_2(uint mask, ivec3 c) { return (mask >> (c.x + 2 * c.y + 4 * c.z) & 1u) != 0u ? -1 : 0; }

// --- a node, as fetched (NodeEntry) ---

// Child c: -1 when it is not empty, else the shift of the side of an empty aligned cell around it, in children.
int empty_child_shift(uvec4 node, ivec3 c) {
#if TREE_N == 4
    return empty_shift_4(node.xy, c);
#else
    return empty_shift_2(node.x, c);
#endif
}
bool has_no_child(uvec4 node) { return (node.x | node.y) == 0u; }
bool has_children(uvec4 node) { return node.z != 0u; }
uint child_entry(uvec4 node, ivec3 c) { return node.z + uint(c.x + TREE_N * (c.y + TREE_N * c.z)); }
// Slot of its brick; -1: none.
int brick_slot(uvec4 node) { return int(node.w) - 1; }

// A word of a brick's masks likewise: voxel c of a block.
int empty_voxel_shift(uvec2 mask, ivec3 c) { return empty_shift_4(mask, c); }
