// One thread is one voxel of a mip of a new brick, border included: it turns the gathered sums into the
// pool's texels, and clears them for the next batch.
#include "interop/produce.h"
#include "produce/scratch.glsl"
#include "produce/two_normals.glsl"
#include "common/thread.glsl"

#if HAS_COLOR
layout(rgba8, binding = IMAGE_BRICK_COLOR) writeonly uniform image3D brick_color;
#else
layout(r8, binding = IMAGE_BRICK_COLOR) writeonly uniform image3D brick_color;
#endif
layout(rgb10_a2, binding = IMAGE_BRICK_NORMAL) writeonly uniform image3D brick_normal;

uniform uint tile_count;

// The share of the voxel's face that the surface covers, seen along the axis along which it covers most: the
// part that a ray through the voxel meets. A sheet covers the whole face, however thin it is; a wire covers
// as much as it is wide.
float coverage(uvec2 mask) {
    const uint along_z = (mask.x | mask.x >> 16 | mask.y | mask.y >> 16) & 0xFFFFu;
    uvec2 y = mask | mask >> 4;
    y = (y | y >> 8) & 0x000F000Fu;
    uvec2 x = mask | mask >> 1;
    x = (x | x >> 2) & 0x11111111u;
    const int most = max(bitCount(along_z), max(bitCount(y.x) + bitCount(y.y), bitCount(x.x) + bitCount(x.y)));
    return float(most) / 16.0;
}

// Mean of the three sums from word `first` on.
vec3 mean_of(uint first, float weight) {
    return vec3(int(scratch[first]), int(scratch[first + 1u]), int(scratch[first + 2u])) / (weight * NORMAL_UNIT);
}

#define LEAST_NORMAL 1e-3  // a shorter normal is none

vec4 packed_normals(uint sums, float weight) {
    const vec3 mean = mean_of(sums + SUM_NORMAL, weight);
    const vec3 x = mean_of(sums + SUM_MOMENTS, weight);  // xx, xy, xz
    const vec3 y = mean_of(sums + SUM_MOMENTS + 2u, weight);  // xz, yy, yz
    const float zz = max(1.0 - x.x - y.y, 0.0);
    const Normals found = two_normals(mean, mat3(x, vec3(x.y, y.y, y.z), vec3(x.z, y.z, zz)));
    return length(found.first) > LEAST_NORMAL ? pack_normals(found) : vec4(0.0);
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

    float covered = 0.0;
    vec4 normals = vec4(0.0);
    vec3 color = vec3(0.0);
    if ((mask.x | mask.y) != 0u) {
        const uint sums = sums_offset + i * uint(SUM_WORDS);
        covered = coverage(mask);
        const float weight = float(min(scratch[sums + SUM_WEIGHT], WEIGHT_LIMIT));
        normals = packed_normals(sums, weight);
#if HAS_COLOR
        const vec3 colors = vec3(scratch[sums + SUM_COLOR], scratch[sums + SUM_COLOR + 1u],
                                 scratch[sums + SUM_COLOR + 2u]);
        color = sqrt(clamp(colors / (weight * COLOR_UNIT), 0.0, 1.0));
#endif
        scratch[2u * i] = 0u;
        scratch[2u * i + 1u] = 0u;
        for (uint w = 0u; w < uint(SUM_WORDS); ++w) scratch[sums + w] = 0u;
    }
    const ivec3 texel = first_texel(tiles[tile].slot, mip) + place;
    // Colours are weighted with the coverage, so that a filtered fetch does not mix in empty voxels.
#if HAS_COLOR
    imageStore(brick_color, texel, vec4(color * covered, covered));
#else
    imageStore(brick_color, texel, vec4(covered));
#endif
    imageStore(brick_normal, texel, normals);
}
