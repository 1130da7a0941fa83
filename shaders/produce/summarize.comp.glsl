// One thread is one summary word of a new brick: one bit for each of 64 blocks, whether a voxel of any mip is
// occupied in it.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"
#include "common/thread.glsl"

uniform uint tile_count;

// Whether a voxel of any mip is occupied in a block. Without alpha masks, the finest mip decides for all mips
// whose voxels are no larger than a block.
bool is_full(uint tile, uint block) {
    const uvec2 mask = head_mask(tile, SUMMARY_WORDS + int(block));
    bool full = (mask.x | mask.y) != 0u;
#if BRICK_MIPS > 2 || HAS_MASK && BRICK_MIPS > 0
    // Occupied voxels of every mip lie in occupied voxels of the coarsest mip.
    const int b = int(block);
    const ivec3 place = ivec3(b % BLOCKS_PER_SIDE, b / BLOCKS_PER_SIDE % BLOCKS_PER_SIDE,
                              b / (BLOCKS_PER_SIDE * BLOCKS_PER_SIDE));
    const int blocks = MIP_BLOCKS_PER_SIDE(BRICK_MIPS);
    const ivec3 low = 4 * place >> BRICK_MIPS;
    const ivec3 high = 4 * place + 3 >> BRICK_MIPS;
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                const uvec2 word =
                    head_mask(tile, first_mask_of(BRICK_MIPS) + x / 4 + blocks * (y / 4 + blocks * (z / 4)));
                full = full || ((z % 4 < 2 ? word.x : word.y) >> (x % 4 + 4 * (y % 4) + 16 * (z % 2)) & 1u) != 0u;
            }
        }
    }
#endif
    return full;
}

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(SUMMARY_WORDS)) return;
    const uint tile = i / uint(SUMMARY_WORDS);
    const uint word = i % uint(SUMMARY_WORDS);
    uvec2 summary = uvec2(0u);
    for (uint bit = 0u; bit < 64u && word * 64u + bit < uint(BLOCKS); ++bit) {
        const uint full = is_full(tile, word * 64u + bit) ? 1u : 0u;
        if (bit < 32u) summary.x |= full << bit;
        else summary.y |= full << (bit - 32u);
    }
    store_head_mask(tile, int(word), summary);
}
