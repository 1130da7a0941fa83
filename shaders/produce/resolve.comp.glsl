// One thread is one record of a new brick: it finds the voxel, turns the gathered sums into the record, and
// clears them for the next batch.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"
#include "produce/two_normals.glsl"
#include "pool/coverage.glsl"
#include "common/thread.glsl"

layout(r32ui, binding = IMAGE_BRICK_WORDS) writeonly uniform uimageBuffer brick_words;

uniform uint tile_count;
uniform uint record_count;  // of all tiles

// Mean of the three sums from word `first` on.
vec3 mean_of(uint first, float weight) {
    return vec3(int(scratch[first]), int(scratch[first + 1u]), int(scratch[first + 2u])) / (weight * NORMAL_UNIT);
}

#define LEAST_NORMAL 1e-3  // a shorter normal is none

uint packed_normals(uint sums, float weight) {
    const vec3 mean = mean_of(sums + SUM_NORMAL, weight);
    const vec3 x = mean_of(sums + SUM_MOMENTS, weight);  // xx, xy, xz
    const vec3 y = mean_of(sums + SUM_MOMENTS + 2u, weight);  // xz, yy, yz
    const float zz = max(1.0 - x.x - y.y, 0.0);
    const Normals found = two_normals(mean, mat3(x, vec3(x.y, y.y, y.z), vec3(x.z, y.z, zz)));
    return length(found.first) > LEAST_NORMAL ? pack_normals(found) : 0u;
}

uint tile_of_record(uint record) {
    uint low = 0u;
    for (uint end = tile_count; end - low > 1u;) {
        const uint middle = (low + end) / 2u;
        if (tiles[middle].first_record <= record) low = middle;
        else end = middle;
    }
    return low;
}

// The last group whose records do not begin behind this record of the tile.
int group_of_record(uint tile, uint record) {
    const uint ranks = tile * uint(HEAD_WORDS) + uint(HEAD_RANKS);
    int low = 0;
    for (int end = GROUPS; end - low > 1;) {
        const int middle = (low + end) / 2;
        if (heads[ranks + uint(middle)] <= record) low = middle;
        else end = middle;
    }
    return low;
}

void store_record(uint tile, uint record, bool has_marks, uint normals, uint color, uvec2 marks) {
    const uint first_word = tiles[tile].first_word;
    if (first_word == NO_ROOM) return;
    const int word = int(first_word) + HEAD_WORDS + int(record) * RECORD_WORDS;
    imageStore(brick_words, word, uvec4(normals));
#if HAS_COLOR
    imageStore(brick_words, word + 1, uvec4(color));
#endif
    if (!has_marks) return;
    const int mark = int(first_word + heads[tile * uint(HEAD_WORDS) + uint(HEAD_MARKS)] + 2u * record);
    imageStore(brick_words, mark, uvec4(marks.x));
    imageStore(brick_words, mark + 1, uvec4(marks.y));
}

void main() {
    const uint i = thread_index();
    if (i >= record_count) return;
    const uint tile = tile_of_record(i);
    const uint record = i - tiles[tile].first_record;
    GroupBit at = GroupBit(group_of_record(tile, record), 0);
    const uint rank = heads[tile * uint(HEAD_WORDS) + uint(HEAD_RANKS + at.group)];
    at.bit = bit_of_rank(head_mask(tile, SUMMARY_WORDS + at.group), int(record - rank));
    const int mip = mip_of_group(at.group);
    const uint voxel = scratch_voxel(tile, mip, voxel_of_bit(at, mip) + 1);
    const uvec2 marks = uvec2(scratch[2u * voxel], scratch[2u * voxel + 1u]);

    uint normals = 0u;
    uint color = 0u;
    // With alpha masks, a voxel of a mip may be occupied because a finer voxel in it is.
    if ((marks.x | marks.y) != 0u) {
        const uint sums = sums_offset + voxel * uint(SUM_WORDS);
        const float weight = float(min(scratch[sums + SUM_WEIGHT], WEIGHT_LIMIT));
        normals = packed_normals(sums, weight);
#if HAS_COLOR
        const vec3 colors = vec3(scratch[sums + SUM_COLOR], scratch[sums + SUM_COLOR + 1u],
                                 scratch[sums + SUM_COLOR + 2u]);
        // Square roots, whose steps look even to the eye; weighted with the coverage, as what is filtered.
        const float covered = coverage_of_marks(marks);
        color = packUnorm4x8(vec4(sqrt(clamp(colors / (weight * COLOR_UNIT), 0.0, 1.0)) * covered, covered));
#endif
        scratch[2u * voxel] = 0u;
        scratch[2u * voxel + 1u] = 0u;
        for (uint w = 0u; w < uint(SUM_WORDS); ++w) scratch[sums + w] = 0u;
    }
    store_record(tile, record, at.group < MARKED_GROUPS, normals, color, marks);
}
