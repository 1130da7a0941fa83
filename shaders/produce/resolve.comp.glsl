// One thread is one voxel of a mip of a new brick, border included: it turns the gathered sums into the voxel's
// record, and clears them for the next batch.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/heads.glsl"
#include "produce/two_normals.glsl"
#include "pool/coverage.glsl"
#include "common/thread.glsl"

layout(r32ui, binding = IMAGE_BRICK_WORDS) writeonly uniform uimageBuffer brick_words;

uniform uint tile_count;

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

// Writes the record of a voxel, if the voxel is occupied and the brick has room.
void store_record(uint tile, int mip, ivec3 v, uint normals, uint color, uvec2 marks) {
    const GroupBit at = group_bit(v, mip);
    const uvec2 occupied = head_mask(tile, SUMMARY_WORDS + at.group);
    const uint first_word = tiles[tile].first_word;
    if (first_word == NO_ROOM || !has_bit(occupied, at.bit)) return;
    const uint head = tile * uint(HEAD_WORDS);
    const int record = int(heads[head + uint(HEAD_RANKS + at.group)]) + bits_below(occupied, at.bit);
    const int word = int(first_word) + HEAD_WORDS + record * RECORD_WORDS;
    imageStore(brick_words, word, uvec4(normals));
#if HAS_COLOR
    imageStore(brick_words, word + 1, uvec4(color));
#endif
    if (at.group >= MARKED_GROUPS) return;
    const int mark = int(first_word + heads[head + uint(HEAD_MARKS)]) + 2 * record;
    imageStore(brick_words, mark, uvec4(marks.x));
    imageStore(brick_words, mark + 1, uvec4(marks.y));
}

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(VOXELS)) return;
    const uint tile = i / uint(VOXELS);
    int v = int(i % uint(VOXELS));
    int mip = 0;
    for (; mip < BRICK_MIPS && v >= MIP_VOXELS(mip); ++mip) v -= MIP_VOXELS(mip);
    const int side = MIP_SIDE(mip);
    const ivec3 place = ivec3(v % side, v / side % side, v / (side * side));
    const uvec2 mask = uvec2(scratch[2u * i], scratch[2u * i + 1u]);

    uint normals = 0u;
    uint color = 0u;
    if ((mask.x | mask.y) != 0u) {
        const uint sums = sums_offset + i * uint(SUM_WORDS);
        const float weight = float(min(scratch[sums + SUM_WEIGHT], WEIGHT_LIMIT));
        normals = packed_normals(sums, weight);
#if HAS_COLOR
        const vec3 colors = vec3(scratch[sums + SUM_COLOR], scratch[sums + SUM_COLOR + 1u],
                                 scratch[sums + SUM_COLOR + 2u]);
        // Square roots, whose steps look even to the eye; weighted with the coverage, as what is filtered.
        const float covered = coverage_of_marks(mask);
        color = packUnorm4x8(vec4(sqrt(clamp(colors / (weight * COLOR_UNIT), 0.0, 1.0)) * covered, covered));
#endif
        scratch[2u * i] = 0u;
        scratch[2u * i + 1u] = 0u;
        for (uint w = 0u; w < uint(SUM_WORDS); ++w) scratch[sums + w] = 0u;
    }
#if !(HAS_MASK && BRICK_MIPS > 0)
    else return;  // else a voxel may be occupied because a finer voxel in it is
#endif
    store_record(tile, mip, place - 1, normals, color, mask);
}
