// One thread is one new brick: it numbers the records of its groups.
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
    for (int group = 0; group < GROUPS; ++group) {
        heads[head + uint(HEAD_RANKS + group)] = records;
        const uvec2 mask = head_mask(tile, SUMMARY_WORDS + group);
        records += uint(bitCount(mask.x) + bitCount(mask.y));
    }
    heads[head + uint(HEAD_TABLE)] = uint(HEAD_WORDS) + records * uint(RECORD_WORDS);
    counts[tile] = PackedCount(records, 0u);
}
