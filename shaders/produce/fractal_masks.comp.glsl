// One thread is one word of a new brick's masks. Only occupied tiles have bricks, so the masks are the same
// in all bricks.
#include "interop/produce.h"
#include "produce/fractal.glsl"
#include "pool/brick_masks.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_BRICK_MASKS) writeonly buffer MaskBlock { uvec2 brick_masks[]; };

ivec3 place_of(int i, int side) { return ivec3(i % side, i / side % side, i / (side * side)); }

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(MASK_WORDS)) return;
    const int word = int(i % uint(MASK_WORDS));
    const bool is_summary = word < SUMMARY_WORDS;
    const int block = word - SUMMARY_WORDS;
    uvec2 mask = uvec2(0u);
    for (int bit = 0; bit < (is_summary ? 64 : CUBE(BLOCK_SIDE)); ++bit) {
        bool full;
        if (is_summary) {
            const int of = 64 * word + bit;
            full = of < BLOCKS && in_set(digits_of(place_of(of, BLOCKS_PER_SIDE)));
        } else {
            full = in_set(digits_of(BLOCK_SIDE * place_of(block, BLOCKS_PER_SIDE) + place_of(bit, BLOCK_SIDE)));
        }
        if (!full) continue;
        if (bit < 32) mask.x |= 1u << bit;
        else mask.y |= 1u << (bit - 32);
    }
    const uint slot = uint(tiles[i / uint(MASK_WORDS)].slot);
    brick_masks[slot * uint(MASK_WORDS) + uint(word)] = mask;
}
