// One thread is one new brick: it numbers the records of its groups, and finds how much room the brick needs.
#include "interop/produce.h"
#include "produce/heads.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_BRICK_COUNTS) writeonly buffer CountBlock { PackedCount counts[]; };

uniform uint tile_count;

void main() {
    const uint tile = thread_index();
    if (tile >= tile_count) return;
    const uint head = tile * uint(HEAD_WORDS);
    uint records = 0u;
    uint inner = 0u;
    uint marked = 0u;
    for (int group = 0; group < GROUPS; ++group) {
        if (group == INNER_GROUPS) inner = records;
        if (group == MARKED_GROUPS) marked = records;
        heads[head + uint(HEAD_RANKS + group)] = records;
        const uvec2 mask = head_mask(tile, SUMMARY_WORDS + group);
        records += uint(bitCount(mask.x) + bitCount(mask.y));
    }
    if (MARKED_GROUPS == GROUPS) marked = records;
    const uint marks = uint(HEAD_WORDS) + records * uint(RECORD_WORDS);
    heads[head + uint(HEAD_MARKS)] = marks;
    // A brick whose border alone is occupied is empty.
    counts[tile] = PackedCount(records, inner == 0u ? 0u : marks + 2u * marked);
}
