// One thread is 64 voxels of the border of a mip of a new brick: it packs their occupancy into a 64-bit mask.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"
#include "common/thread.glsl"

#define ALL_BORDER_GROUPS (GROUPS - INNER_GROUPS)

uniform uint tile_count;

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(ALL_BORDER_GROUPS)) return;
    const uint tile = i / uint(ALL_BORDER_GROUPS);
    const int group = INNER_GROUPS + int(i % uint(ALL_BORDER_GROUPS));
    const int mip = mip_of_group(group);
    const int first = 64 * (group - first_border_group(mip));
    uvec2 mask = uvec2(0u);
    for (int bit = 0; bit < 64 && first + bit < BORDER_VOXELS(mip); ++bit) {
        const uint voxel = scratch_voxel(tile, mip, border_voxel(first + bit, mip) + 1);
        const uint occupied = (scratch[2u * voxel] | scratch[2u * voxel + 1u]) != 0u ? 1u : 0u;
        if (bit < 32) mask.x |= occupied << bit;
        else mask.y |= occupied << (bit - 32);
    }
    store_head_mask(tile, SUMMARY_WORDS + group, mask);
}
