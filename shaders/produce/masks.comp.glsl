// One thread is one block of voxels of a new brick: it packs their occupancy into the 64-bit mask that rays skip by.
// defines: BRICK_M=27 HAS_COLOR=1
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
    const ivec3 low = BLOCK_SIDE * ivec3(block % BLOCKS_A_SIDE, block / BLOCKS_A_SIDE % BLOCKS_A_SIDE,
                                         block / (BLOCKS_A_SIDE * BLOCKS_A_SIDE));
    uvec2 mask = uvec2(0u);
    for (int z = 0; z < BLOCK_SIDE; ++z) {
        for (int y = 0; y < BLOCK_SIDE; ++y) {
            for (int x = 0; x < BLOCK_SIDE; ++x) {
                const uint voxel = scratch_voxel(tile, low + ivec3(x, y, z) + 1);
                const uint bit = (scratch[2u * voxel] | scratch[2u * voxel + 1u]) != 0u ? 1u : 0u;
                const int place = x + BLOCK_SIDE * (y + BLOCK_SIDE * z);
                if (place < 32) mask.x |= bit << place;
                else mask.y |= bit << (place - 32);
            }
        }
    }
    const uint slot = uint(tiles[tile].slot_texel.w);
    brick_masks[slot * uint(MASK_WORDS_A_SLOT) + uint(SUMMARY_WORDS) + uint(block)] = mask;
}
