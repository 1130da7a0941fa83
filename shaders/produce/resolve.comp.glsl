// One thread is one record of a new brick: it stores the voxel's normals and slab, its colour and its marks, and
// clears what was gathered for the next batch.
#include "produce/records.glsl"
#include "pool/coverage.glsl"
#include "common/thread.glsl"

layout(r32ui, binding = IMAGE_BRICK_WORDS) writeonly uniform uimageBuffer brick_words;

uint color_of(uint sums, uvec2 marks) {
    const float weight = float(min(scratch[sums + SUM_WEIGHT], WEIGHT_LIMIT));
    const vec3 colors = vec3(scratch[sums + SUM_COLOR], scratch[sums + SUM_COLOR + 1u],
                             scratch[sums + SUM_COLOR + 2u]);
    // Square roots, whose steps look even to the eye; weighted with the coverage, as what is filtered.
    const float covered = coverage_of_marks(marks);
    return packUnorm4x8(vec4(sqrt(clamp(colors / (weight * COLOR_UNIT), 0.0, 1.0)) * covered, covered));
}

void store_two_words(int word, uvec2 words) {
    imageStore(brick_words, word, uvec4(words.x));
    imageStore(brick_words, word + 1, uvec4(words.y));
}

void store(Record record, uint normals, uint color, uvec2 marks) {
    const uint first_word = tiles[record.tile].first_word;
    if (first_word == NO_ROOM) return;
    const int word = int(first_word) + HEAD_WORDS + int(record.number) * RECORD_WORDS;
    imageStore(brick_words, word, uvec4(normals));
#if HAS_COLOR
    imageStore(brick_words, word + 1, uvec4(color));
#endif
    if (!record.is_in_table) return;
    const uint in_table = record.number >> 5;
    const uvec2 entry = marked[table_of(record.tile) + in_table];
    const uint bit = record.number & 31u;
    if (bit == 0u) {
        const uint table = heads[record.tile * uint(HEAD_WORDS) + uint(HEAD_TABLE)];
        store_two_words(int(first_word + table + 2u * in_table), entry);
    }
    if ((entry.x >> bit & 1u) == 0u) return;
    store_two_words(int(first_word + entry.y) + 2 * bitCount(entry.x & (1u << bit) - 1u), marks);
}

void main() {
    const uint i = thread_index();
    if (i >= record_count) return;
    const Record record = record_at(i);
    const uvec2 marks = marks_of(record);
    uint normals = 0u;
    uint color = 0u;
    // With alpha masks, a voxel of a mip may be occupied because a finer voxel in it is.
    if ((marks.x | marks.y) != 0u) {
        const uint sums = sums_of(record);
        normals = scratch[sums + PACKED_NORMALS];
#if HAS_COLOR
        color = color_of(sums, marks);
#endif
        scratch[2u * record.voxel] = 0u;
        scratch[2u * record.voxel + 1u] = 0u;
        for (uint w = 0u; w < uint(SUM_WORDS); ++w) scratch[sums + w] = 0u;
    }
    store(record, normals, color, marks);
}
