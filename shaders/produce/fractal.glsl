// The set of renderer/produce/fractal_content.h inside one tile and around it: the sponge where N = 3, else
// the fractal.
#include "interop/produce.h"

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { FractalTile tiles[]; };

uniform uint tile_count;

// digits_of() prepares a place in a tile for in_set(), each coordinate by itself.
#if TREE_N == 3
// Bit i: whether digit i of the coordinate, in base 3, is 1: then a cube of 27 on the way down lies in the
// middle along this axis. In the sponge no cube lies in the middle along two axes.
ivec3 digits_of(ivec3 place) {
    ivec3 ones = ivec3(0);
    int bit = 1;
    for (int side = 1; side < BRICK_M; side *= 3) {
        const ivec3 rest = place / 3;
        ones |= ivec3(equal(place - 3 * rest, ivec3(1))) * bit;
        place = rest;
        bit *= 2;
    }
    return ones;
}
bool in_set(ivec3 digits) { return ((digits.x & digits.y) | (digits.y & digits.z) | (digits.z & digits.x)) == 0; }
#else
ivec3 digits_of(ivec3 place) { return place; }
bool in_set(ivec3 digits) { return (digits.x & digits.y & digits.z) == 0; }
#endif
