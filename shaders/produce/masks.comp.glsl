// One thread is one block of 4^3 voxels of a new brick: it packs their occupancy into the 64-bit mask that rays skip by.
// defines: BRICK_M=16 HAS_COLOR=1
// defines: BRICK_M=8 HAS_COLOR=0
#include "produce/scratch.glsl"
#include "pool/brick_masks.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = SSBO_BRICK_MASKS) writeonly buffer MaskBlock { uvec2 brick_masks[]; };

uniform uint tile_count;

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= tile_count * uint(BLOCKS)) return;
    const uint tile = i / uint(BLOCKS);
    const int block = int(i % uint(BLOCKS));
    const ivec3 low = 4 * ivec3(block % BLOCKS_A_SIDE, block / BLOCKS_A_SIDE % BLOCKS_A_SIDE,
                                block / (BLOCKS_A_SIDE * BLOCKS_A_SIDE));
    uvec2 mask = uvec2(0u);
    for (int z = 0; z < 4; ++z) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 4; ++x) {
                const uint voxel = scratch_voxel(tile, low + ivec3(x, y, z) + 1);
                const uint bit = (scratch[2u * voxel] | scratch[2u * voxel + 1u]) != 0u ? 1u : 0u;
                if (z < 2) mask.x |= bit << (x + 4 * y + 16 * z);
                else mask.y |= bit << (x + 4 * y + 16 * (z - 2));
            }
        }
    }
    const uint slot = uint(tiles[tile].slot_texel.w);
    brick_masks[slot * uint(MASK_WORDS_A_SLOT) + uint(SUMMARY_WORDS) + uint(block)] = mask;
}
