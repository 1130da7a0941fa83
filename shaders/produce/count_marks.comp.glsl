// One thread is one new brick: it numbers the marks that are kept, and finds how much room the brick needs.
#include "produce/records.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_BRICK_COUNTS) buffer CountBlock { PackedCount counts[]; };

void main() {
    const uint tile = thread_index();
    if (tile >= tile_count) return;
    const uint head = tile * uint(HEAD_WORDS);
    const uint inner = heads[head + uint(HEAD_RANKS + INNER_GROUPS)];
    const uint in_table = TABLE_GROUPS == GROUPS ? counts[tile].records : inner;
    const uint entries = (in_table + 31u) / 32u;
    const uint first = table_of(tile);
    uint place = heads[head + uint(HEAD_TABLE)] + 2u * entries;
    for (uint i = first; i < first + entries; ++i) {
        marked[i].y = place;
        place += 2u * uint(bitCount(marked[i].x));
    }
    // A brick whose border alone is occupied is empty.
    counts[tile].words = inner == 0u ? 0u : place;
}
