// One thread is one voxel of a new brick of the fractal, border included: it computes coverage and normal.
#include "interop/produce.h"
#include "produce/fractal.glsl"
#include "pool/brick_normals.glsl"
#include "common/thread.glsl"

layout(r8, binding = IMAGE_BRICK_COLOR) writeonly uniform image3D brick_color;
layout(rgb10_a2, binding = IMAGE_BRICK_NORMAL) writeonly uniform image3D brick_normal;

#define SIDE (BRICK_M + 2)
#define VOXELS (SIDE * SIDE * SIDE)

// A voxel at most one tile away.
struct Voxel {
    ivec3 tile;    // tile of the voxel, [0, 2]; 1 is the brick's tile
    ivec3 digits;  // digits_of() the voxel's place in its tile
};

Voxel voxel_at(ivec3 place) {
    const ivec3 tile = (place + BRICK_M) / BRICK_M;
    return Voxel(tile, digits_of(place + BRICK_M - tile * BRICK_M));
}

// Whether a voxel is occupied: its tile must not be empty, and its place in the tile must be in the set.
bool occupied(uint neighbours, Voxel voxel) {
    const int number = voxel.tile.x + 3 * (voxel.tile.y + 3 * voxel.tile.z);
    return (neighbours >> number & 1u) != 0u && in_set(voxel.digits);
}

// Takes each coordinate from `before`, `here` or `after`, for an offset of -1, 0 or 1.
ivec3 pick(ivec3 offset, ivec3 before, ivec3 here, ivec3 after) {
    return mix(mix(before, after, equal(offset, ivec3(1))), here, equal(offset, ivec3(0)));
}

void main() {
    const uint i = thread_index();
    if (i >= tile_count * uint(VOXELS)) return;
    const uint tile = i / uint(VOXELS);
    const int v = int(i % uint(VOXELS));
    const ivec3 place = ivec3(v % SIDE, v / SIDE % SIDE, v / (SIDE * SIDE));
    const uint neighbours = tiles[tile].neighbours;

    // The projection of an occupied voxel of the fractal along an axis is full at any depth, so its coverage
    // is 1. That of the sponge is not, but voxels of the sponge are taken for solid at each level (Crassin et
    // al. 2008, section 7).
    const Voxel here = voxel_at(place - 1);
    const float covered = occupied(neighbours, here) ? 1.0 : 0.0;
    const Voxel before = voxel_at(place - 2);
    const Voxel after = voxel_at(place);
    ivec3 away = ivec3(0);
    for (int number = 0; number < 27; ++number) {
        const ivec3 offset = ivec3(number % 3, number / 3 % 3, number / 9) - 1;
        const Voxel near = Voxel(pick(offset, before.tile, here.tile, after.tile),
                                 pick(offset, before.digits, here.digits, after.digits));
        if (occupied(neighbours, near)) away -= offset;
    }
    const float size = length(vec3(away));
    const ivec3 texel = tiles[tile].first_texel + place;
    imageStore(brick_color, texel, vec4(covered));
    imageStore(brick_normal, texel, covered * size > 0.0 ? normal_texel(pack_normal(vec3(away))) : vec4(0.0));
}
