// Windows: trees that are too deep for a ray to count their voxels (renderer/march/windows.h,
// shaders/march/windows.glsl).
#ifndef CAIRN_INTEROP_WINDOWS_H
#define CAIRN_INTEROP_WINDOWS_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define UBO_WINDOWS 1  // their number, then MarchWindow from the finest on

// Cubes of 2^3 tiles around the eye, one per level. Log2 of a window's tile, at most, in the voxels that the
// ray counts in: floats tell 2^-7 of one.
#define WINDOW_TILE_BITS 16
#define MAX_WINDOWS 64
// A tile of a window: the number of its entry, or
#define WINDOW_EMPTY 4294967295u    // there is nothing in it
#define WINDOW_MISSING 2147483648u  // plus the entry of its nearest ancestor, which must be subdivided

#ifdef __cplusplus
namespace cairn::interop {
#endif

// 2^3 tiles of one level, with the eye among them. Lengths in its own voxels, positions from its low corner.
struct MarchWindow {
    vec3 eye;
    int level;                // of the tiles
    vec3 light;               // as MarchView.light
    int light_is_positional;  // 0: it is so far away that its direction says all
    ivec3 shift;              // the low corner in the next, coarser window
    int padding;
    uvec4 tiles[2];           // entry of tile x + 2 (y + 2 z), or WINDOW_*
};

#ifdef __cplusplus
static_assert(sizeof(MarchWindow) == 80, "GLSL sees another layout");
static_assert(offsetof(MarchWindow, tiles) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
