// The set of renderer/produce/fractal_content.h inside one tile and around it.
#include "interop/bindings.h"
#include "interop/types.h"

layout(std430, binding = SSBO_BRICK_TILES) readonly buffer TileBlock { FractalTile tiles[]; };

uniform uint tile_count;

bool in_set(ivec3 place) { return (place.x & place.y & place.z) == 0; }
