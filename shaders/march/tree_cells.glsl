// Cells of the tree and of its bricks, and the fields of a node.
// Needs the defines of TreeShape::defines(): N = 3 goes with M = 27 and 81, N = 2, 4 and 8 with powers of
// two.
#include "interop/pool.h"

// Packed bricks keep marks: 4^3 finer cells of a voxel, of which rays meet those that are set; or a slab, or both.
// Voxels that are cut in thirds have no finer cells that nest.
#if PACKED && CELL_BASE == 2 && GEOMETRY != 0
#define MARKS 1
#define MARK_SHIFT MARK_BITS
#else
#define MARKS 0
#define MARK_SHIFT 0
#endif
#include "march/cells.glsl"

// A block is the cube of BLOCK_SIDE^3 voxels whose bits are one word of a brick's masks.
#if CELL_BASE == 3
#define BLOCK_SHIFT 1
#else
#define BLOCK_SHIFT 2
#endif

// The finest tile's side, and the root's.
#define TILE_SHIFT (M_SHIFT + MARK_SHIFT)
#define ROOT_SHIFT (TILE_SHIFT + N_SHIFT * MAX_LEVEL)
#define ROOT_SIDE cell_side(ROOT_SHIFT)

// Side, in finest cells, of the cube that rays march. With windows, it consists of 2^3 cubes from which descents start
// (windows.glsl); else it is the root.
#if WINDOWS
#define MARCHED_SIDE (2 * ROOT_SIDE)
#else
#define MARCHED_SIDE ROOT_SIDE
#endif

// Cell c of a 4^3 mask, x fastest: -1 if it is occupied, else log2 of the side of an empty aligned cell
// around it.
int empty_shift_4(uvec2 mask, ivec3 c) {
    const uint word = (c.z & 2) == 0 ? mask.x : mask.y;
    if ((word >> (c.x + 4 * c.y + 16 * (c.z & 1)) & 1u) != 0u) return -1;
    return (word >> ((c.x & 2) + 4 * (c.y & 2)) & 0x00330033u) == 0u ? 1 : 0;
}

// Cell c of a 2^3 mask: -1 if it is occupied, else 0.
int empty_shift_2(uint mask, ivec3 c) { return (mask >> (c.x + 2 * c.y + 4 * c.z) & 1u) != 0u ? -1 : 0; }

// Cell c of a 3^3 mask: -1 if it is occupied, else 0.
int empty_shift_3(uint mask, ivec3 c) { return (mask >> (c.x + 3 * c.y + 9 * c.z) & 1u) != 0u ? -1 : 0; }

// --- fields of a node, as fetched (NodeEntry) ---

// Child c of a node: -1 if it may be occupied, else log2 of the side, in children, of an empty aligned cell
// around it.
int empty_child_shift(uvec4 node, ivec3 c) {
#if TREE_N == 8
    // The mask has 64 bits, one per group of 2^3 children. The entry of a child marks it if it alone is
    // empty.
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
// Slot of the node's brick; -1: no brick.
int brick_slot(uvec4 node) { return int(node.w & NODE_SLOT) - 1; }
// Whether the tile holds one value at its level, and needs no brick; is_empty: whether that value is 0.
bool is_constant(uvec4 node) { return (node.w & NODE_CONSTANT) != 0u; }
bool is_empty(uvec4 node) { return (node.w & NODE_EMPTY) != 0u; }
// Whether finer levels add nothing to the tile: rays whose cones ask for finer levels take the tile's voxels.
bool is_final(uvec4 node) { return (node.w & NODE_FINAL) != 0u; }

// Voxel c of a block, whose bits are a word of a brick's masks: -1 if it is occupied, else log2 of the side
// of an empty aligned cell around it.
int empty_voxel_shift(uvec2 mask, ivec3 c) {
#if CELL_BASE == 3
    return empty_shift_3(mask.x, c);
#else
    return empty_shift_4(mask, c);
#endif
}
