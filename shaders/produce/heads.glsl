// The heads of the packed bricks of a batch, before the bricks have a place in the pool.
#include "interop/produce.h"
#include "pool/packed_brick.glsl"

layout(std430, binding = SSBO_BRICK_HEADS) buffer HeadBlock { uint heads[]; };

// First of the two words of a 64-bit word of the masks.
uint head_mask_word(uint tile, int word) { return tile * uint(HEAD_WORDS) + uint(HEAD_MASKS + 2 * word); }

uvec2 head_mask(uint tile, int word) {
    const uint at = head_mask_word(tile, word);
    return uvec2(heads[at], heads[at + 1u]);
}

void store_head_mask(uint tile, int word, uvec2 mask) {
    const uint at = head_mask_word(tile, word);
    heads[at] = mask.x;
    heads[at + 1u] = mask.y;
}
