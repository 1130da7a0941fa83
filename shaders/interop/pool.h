// The node pool and the brick pool, as rays read them.
#ifndef CAIRN_INTEROP_POOL_H
#define CAIRN_INTEROP_POOL_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define TEXTURE_NODES 0         // NodeEntry
// Dense bricks.
#define TEXTURE_BRICK_MASKS 1
#define TEXTURE_BRICK_COLOR 2   // colour and coverage, or coverage alone, or a volume's density
#define TEXTURE_BRICK_NORMAL 3
// Packed bricks.
#define TEXTURE_BRICK_WORDS 1   // R32UI: the words of all bricks (shaders/pool/packed_brick.glsl)
#define TEXTURE_BRICK_STARTS 2  // R32UI: a slot's first word
#define TEXTURE_NODE_MEANS 5    // RGBA8 in a uint per node entry: the value of constant tiles

// NodeEntry.brick: the slot + 1, and flags of the tile.
#define NODE_SLOT 0x00FFFFFFu
#define NODE_PRODUCED 0x10000000u  // the tile has been produced, and the flags below hold
#define NODE_FINAL 0x20000000u     // finer levels add nothing to the tile: it has no children
#define NODE_EMPTY 0x40000000u     // the tile is constant, and its value is 0
#define NODE_CONSTANT 0x80000000u  // the tile holds one value at its level, and needs no brick

// Voxels across the root cube stay below this, because a ray state packs three coordinates in 63 bits.
#define MAX_RESOLUTION_BITS 21

// Packed bricks keep the marks of a voxel: 2^MARK_BITS finer cells along each axis. Rays count in these cells.
#define MARK_BITS 2

// GEOMETRY: what rays meet in a voxel of a packed brick (VoxelGeometry in renderer/pool/tree_shape.h). With neither, the
// voxel itself; with both, what lies in both.
#define GEOMETRY_MARKS 1
#define GEOMETRY_SLABS 2

#ifdef __cplusplus
namespace cairn::interop {
#endif

// One tile in the node pool (Crassin et al. 2008, section 4.2). An empty tile has no entry: its bit in the
// parent's mask is 0. With N = 8 a bit stands for a group of 2^3 children, bit x + 4 (y + 4 z); an empty
// child in a group that is not empty has an entry with NODE_EMPTY.
struct NodeEntry {
    uvec2 child_mask;  // bit x + N (y + N z): child (x, y, z) is not empty
    uint children;     // number of the first child's entry; 0 = leaf
    // NODE_SLOT: slot + 1, 0 = no brick; the other bits are NODE_* flags.
    uint brick;
};

#ifdef __cplusplus
static_assert(sizeof(NodeEntry) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
