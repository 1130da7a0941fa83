// The set of renderer/produce/fractal_content.h inside one tile and around it: the sponge where N = 3, else the fractal.
#include "interop/bindings.h"
#include "interop/types.h"

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { FractalTile tiles[]; };

uniform uint tile_count;

#if TREE_N == 3
// No place of a cube of 27 on the way down lies in the middle of two axes.
bool in_set(ivec3 place) {
    for (int side = 1; side < BRICK_M; side *= 3) {
        const ivec3 in_middle = ivec3(equal(place / side % 3, ivec3(1)));
        if (in_middle.x + in_middle.y + in_middle.z > 1) return false;
    }
    return true;
}
#else
bool in_set(ivec3 place) { return (place.x & place.y & place.z) == 0; }
#endif
