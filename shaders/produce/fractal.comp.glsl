// One thread is one voxel of a new brick of the fractal, border included.
// defines: BRICK_M=16
// defines: BRICK_M=8
#include "produce/fractal.glsl"
#include "pool/brick_normals.glsl"

layout(local_size_x = 64) in;

layout(r8, binding = IMAGE_BRICK_COLOR) writeonly uniform image3D brick_color;
layout(rgb10_a2, binding = IMAGE_BRICK_NORMAL) writeonly uniform image3D brick_normal;

#define SIDE (BRICK_M + 2)
#define VOXELS (SIDE * SIDE * SIDE)

// A voxel at most one tile away: its tile may be empty, and no bit of its place in it may be set in all three.
bool occupied(uint neighbours, ivec3 voxel) {
    const ivec3 tile = (voxel + BRICK_M) / BRICK_M;
    const int number = tile.x + 3 * (tile.y + 3 * tile.z);
    return (neighbours >> number & 1u) != 0u && in_set(voxel & (BRICK_M - 1));
}

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= tile_count * uint(VOXELS)) return;
    const uint tile = i / uint(VOXELS);
    const int v = int(i % uint(VOXELS));
    const ivec3 place = ivec3(v % SIDE, v / SIDE % SIDE, v / (SIDE * SIDE));
    const uint neighbours = tiles[tile].neighbours.x;

    // Any projection of an occupied voxel along an axis is full, at any depth: a whole face is covered.
    const float covered = occupied(neighbours, place - 1) ? 1.0 : 0.0;
    ivec3 away = ivec3(0);
    for (int number = 0; number < 27; ++number) {
        const ivec3 offset = ivec3(number % 3, number / 3 % 3, number / 9) - 1;
        if (occupied(neighbours, place - 1 + offset)) away -= offset;
    }
    const float size = length(vec3(away));
    const ivec3 texel = tiles[tile].slot_texel.xyz + place;
    imageStore(brick_color, texel, vec4(covered));
    imageStore(brick_normal, texel, covered * size > 0.0 ? pack_normal(vec3(away)) : vec4(0.0));
}
