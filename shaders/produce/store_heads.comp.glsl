// One thread is one word of the head of a new brick: it goes to the brick's place in the pool.
#include "interop/produce.h"
#include "produce/heads.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { BrickTile tiles[]; };
layout(r32ui, binding = IMAGE_BRICK_WORDS) writeonly uniform uimageBuffer brick_words;

uniform uint tile_count;

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(HEAD_WORDS)) return;
    const uint first_word = tiles[i / uint(HEAD_WORDS)].first_word;
    if (first_word == NO_ROOM) return;
    imageStore(brick_words, int(first_word + i % uint(HEAD_WORDS)), uvec4(heads[i]));
}
