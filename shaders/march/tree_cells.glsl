// Cells of the tree and of its bricks: aligned cubes whose sides are powers of CELL_BASE in finest-level voxels. A power is
// called a shift, because with CELL_BASE 2 it is one.
// Needs the defines TREE_N, BRICK_M and MAX_LEVEL (the tree's depth); N = 3 goes with M = 27 and 81, N = 2, 4 and 8 with
// powers of two.
#if TREE_N == 3
#define CELL_BASE 3
#else
#define CELL_BASE 2
#endif
#if TREE_N == 8
#define N_SHIFT 3
#elif TREE_N == 4
#define N_SHIFT 2
#else
#define N_SHIFT 1
#endif
#if BRICK_M == 8 || BRICK_M == 27
#define M_SHIFT 3
#elif BRICK_M == 16 || BRICK_M == 81
#define M_SHIFT 4
#elif BRICK_M == 32
#define M_SHIFT 5
#elif BRICK_M == 64
#define M_SHIFT 6
#endif
// A block is the cube of voxels that one word of a brick's masks tells of (BLOCK_SIDE).
#if CELL_BASE == 3
#define BLOCK_SHIFT 1
#else
#define BLOCK_SHIFT 2
#endif

#define ROOT_SHIFT (M_SHIFT + N_SHIFT * MAX_LEVEL)
#define ROOT_SIDE cell_side(ROOT_SHIFT)

// Rays go through windows of 2^3 cubes from which descents start (windows.glsl), or there is one cube, the root.
#ifndef WINDOWS
#define WINDOWS 0
#endif
#if WINDOWS
#define MARCHED_SIDE (2 * ROOT_SIDE)
#else
#define MARCHED_SIDE ROOT_SIDE
#endif

#if CELL_BASE == 3

// Shifts under 20: 3^20 would pass 31 bits. No cell of a tree is larger than 3^13 (MAX_RESOLUTION_BITS).
int cell_side(int shift) {
    return ((shift & 1) != 0 ? 3 : 1) * ((shift & 2) != 0 ? 9 : 1) * ((shift & 4) != 0 ? 81 : 1) *
           ((shift & 8) != 0 ? 6561 : 1) * ((shift & 16) != 0 ? 43046721 : 1);
}
// Number of the cell of that size that a voxel is in, along each axis; for -1 too. Integer quotients are slow on most
// drivers, so a float proposes one that is off by at most one, and its remainder corrects it.
ivec3 cell_of(ivec3 voxel, int shift) {
    const int side = cell_side(shift);
    const ivec3 near = ivec3(vec3(voxel) * (1.0 / float(side)));
    const ivec3 rest = voxel - near * side;
    return near + ivec3(greaterThanEqual(rest, ivec3(side))) - ivec3(lessThan(rest, ivec3(0)));
}
bool same_cell(ivec3 a, ivec3 b, int shift) { return all(equal(cell_of(a, shift), cell_of(b, shift))); }
// The first voxel of that cell.
ivec3 cell_low(ivec3 voxel, int shift) { return cell_of(voxel, shift) * cell_side(shift); }
// Place of that cell in the cell that is `up` powers larger.
ivec3 place_in(ivec3 voxel, int shift, int up) {
    const ivec3 cell = cell_of(voxel, shift);
    return cell - cell_low(cell, up);
}

#else

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

#endif

// A 4^3 mask, x fastest: -1 when cell c is occupied, else log2 of the side of an empty aligned cell around it.
int empty_shift_4(uvec2 mask, ivec3 c) {
    const uint word = (c.z & 2) == 0 ? mask.x : mask.y;
    if ((word >> (c.x + 4 * c.y + 16 * (c.z & 1)) & 1u) != 0u) return -1;
    return (word >> ((c.x & 2) + 4 * (c.y & 2)) & 0x00330033u) == 0u ? 1 : 0;
}

// A 2^3 mask likewise.
int empty_shift_2(uint mask, ivec3 c) { return (mask >> (c.x + 2 * c.y + 4 * c.z) & 1u) != 0u ? -1 : 0; }

// A 3^3 mask likewise.
int empty_shift_3(uint mask, ivec3 c) { return (mask >> (c.x + 3 * c.y + 9 * c.z) & 1u) != 0u ? -1 : 0; }

// --- a node, as fetched (NodeEntry) ---

// Child c: -1 when it may not be empty, else the shift of the side of an empty aligned cell around it, in children.
int empty_child_shift(uvec4 node, ivec3 c) {
#if TREE_N == 8
    // The mask has 64 bits, one for each group of 2^3 children. A child alone is told empty by its own entry.
    const int groups = empty_shift_4(node.xy, c >> 1);
    return groups < 0 ? -1 : groups + 1;
#elif TREE_N == 4
    return empty_shift_4(node.xy, c);
#elif TREE_N == 3
    return empty_shift_3(node.x, c);
#else
    return empty_shift_2(node.x, c);
#endif
}
bool has_no_child(uvec4 node) { return (node.x | node.y) == 0u; }
bool has_children(uvec4 node) { return node.z != 0u; }
uint child_entry(uvec4 node, ivec3 c) { return node.z + uint(c.x + TREE_N * (c.y + TREE_N * c.z)); }
// Slot of its brick; -1: none.
int brick_slot(uvec4 node) { return int(node.w & NODE_SLOT) - 1; }
// One value is all that the tile holds at its own level, and it needs no brick; is_empty: and that value is 0.
bool is_constant(uvec4 node) { return (node.w & NODE_CONSTANT) != 0u; }
bool is_empty(uvec4 node) { return (node.w & NODE_EMPTY) != 0u; }
// Nothing finer adds to the tile: rays that ask for more take what it holds itself.
bool is_final(uvec4 node) { return (node.w & NODE_FINAL) != 0u; }

// A word of a brick's masks likewise: voxel c of a block.
int empty_voxel_shift(uvec2 mask, ivec3 c) {
#if CELL_BASE == 3
    return empty_shift_3(mask.x, c);
#else
    return empty_shift_4(mask, c);
#endif
}
