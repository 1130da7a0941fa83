// One thread is one summary word of a new brick: which of 64 blocks are not empty. With TELL_EMPTY, where the
// oracle is not exact, it also tells whether there is anything in the tile at all.
// defines: BRICK_M=16 HAS_COLOR=1 TELL_EMPTY=0
// defines: BRICK_M=8 HAS_COLOR=0 TELL_EMPTY=1
// defines: BRICK_M=81 HAS_COLOR=0 TELL_EMPTY=1
#include "produce/scratch.glsl"
#include "pool/brick_masks.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = SSBO_BRICK_MASKS) buffer MaskBlock { uvec2 brick_masks[]; };

#if TELL_EMPTY
layout(std430, binding = SSBO_BRICK_FOUND) buffer FoundBlock { uint found[]; };
#endif

uniform uint tile_count;

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= tile_count * uint(SUMMARY_WORDS)) return;
    const uint slot = uint(tiles[i / uint(SUMMARY_WORDS)].slot_texel.w);
    const uint word = i % uint(SUMMARY_WORDS);
    const uint first = slot * uint(MASK_WORDS_A_SLOT);
    uvec2 summary = uvec2(0u);
    for (uint bit = 0u; bit < 64u && word * 64u + bit < uint(BLOCKS); ++bit) {
        const uvec2 mask = brick_masks[first + uint(SUMMARY_WORDS) + word * 64u + bit];
        const uint full = (mask.x | mask.y) != 0u ? 1u : 0u;
        if (bit < 32u) summary.x |= full << bit;
        else summary.y |= full << (bit - 32u);
    }
    brick_masks[first + word] = summary;
#if TELL_EMPTY
    if ((summary.x | summary.y) != 0u) atomicOr(found[i / uint(SUMMARY_WORDS)], 1u);
#endif
}
