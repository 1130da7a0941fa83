// The masks of a brick, dense or packed.
#include "march/buffers.glsl"

#if PACKED
uint brick_word(int place) { return texelFetch(brick_words, place).x; }
uvec2 two_brick_words(int place) { return uvec2(brick_word(place), brick_word(place + 1)); }

// Where a slot's masks are.
int brick_start(int slot) { return int(texelFetch(brick_starts, slot).x); }
// A 64-bit word of the masks (pool/brick_masks.glsl) of a brick that starts there.
uvec2 mask_word(int start, int word) { return two_brick_words(start + HEAD_MASKS + 2 * word); }
#else
int brick_start(int slot) { return slot * MASK_WORDS; }
uvec2 mask_word(int start, int word) { return texelFetch(brick_masks, start + word).xy; }
#endif
