// One thread is one block of voxels of a mip of a new brick: it packs their occupancy into the 64-bit mask by
// which rays skip empty cells. There is one dispatch per mip, the finest first, because a voxel is occupied
// if a finer voxel in it is; the samples of an alpha mask in the coarse voxel alone might miss that.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"
#include "common/thread.glsl"

uniform uint tile_count;
uniform int mip;

#if HAS_MASK && BRICK_MIPS > 0
// Whether one of the 2^3 voxels of the next finer mip in voxel v is occupied.
bool any_finer(uint tile, ivec3 v) {
    const int blocks = MIP_BLOCKS_PER_SIDE(mip - 1);
    const ivec3 c = 2 * v >> 2;
    const ivec3 first = 2 * v & 3;
    const uvec2 mask = head_mask(tile, first_mask_of(mip - 1) + c.x + blocks * (c.y + blocks * c.z));
    return ((first.z == 0 ? mask.x : mask.y) >> (first.x + 4 * first.y) & 0x00330033u) != 0u;
}
#endif

void main() {
    const uint i = thread_index();
    const uint blocks = uint(MIP_BLOCKS(mip));
    if (i >= tile_count * blocks) return;
    const uint tile = i / blocks;
    const int block = int(i % blocks);
    const int blocks_per_side = MIP_BLOCKS_PER_SIDE(mip);
    const ivec3 low = BLOCK_SIDE * ivec3(block % blocks_per_side, block / blocks_per_side % blocks_per_side,
                                         block / (blocks_per_side * blocks_per_side));
    const int side = min(BLOCK_SIDE, MIP_M(mip));
    uvec2 mask = uvec2(0u);
    for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const uint voxel = scratch_voxel(tile, mip, low + ivec3(x, y, z) + 1);
                bool occupied = (scratch[2u * voxel] | scratch[2u * voxel + 1u]) != 0u;
#if HAS_MASK && BRICK_MIPS > 0
                if (mip > 0 && !occupied) occupied = any_finer(tile, low + ivec3(x, y, z));
#endif
                const uint bit = occupied ? 1u : 0u;
                const int place = x + BLOCK_SIDE * (y + BLOCK_SIDE * z);
                if (place < 32) mask.x |= bit << place;
                else mask.y |= bit << (place - 32);
            }
        }
    }
    store_head_mask(tile, first_mask_of(mip) + block, mask);
}
