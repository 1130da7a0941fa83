// Windows, for trees so deep that a ray cannot count their voxels (renderer/march/windows.h,
// shaders/march/windows.glsl): cubes of 2^3 tiles around the eye, one per level.
#ifndef CAIRN_INTEROP_WINDOWS_H
#define CAIRN_INTEROP_WINDOWS_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define UBO_WINDOWS 1  // number of windows, then MarchWindow from the finest on

// Greatest log2 of the side of a window's tile, in the voxels that the ray counts in: floats then resolve
// 2^-7 of a voxel.
#define WINDOW_TILE_BITS 16
#define MAX_WINDOWS 64
// A tile of a window is the number of its entry, or one of these:
#define WINDOW_EMPTY 4294967295u    // the tile is empty
#define WINDOW_MISSING 2147483648u  // this plus the entry of its nearest ancestor, which must be subdivided

#ifdef __cplusplus
namespace cairn::interop {
#endif

// 2^3 tiles of one level around the eye. Lengths are in voxels of the window, positions relative to its low
// corner.
struct MarchWindow {
    vec3 eye;
    int level;                // tree level of the tiles
    vec3 light;               // position of the light, or unit direction to it
    // 0: `light` is a direction, also for a positional light far away.
    int light_is_positional;
    ivec3 shift;              // low corner in voxels of the next, coarser window
    int padding;
    uvec4 tiles[2];           // tile x + 2 (y + 2 z): its entry, or WINDOW_*
};

#ifdef __cplusplus
static_assert(sizeof(MarchWindow) == 80, "GLSL sees another layout");
static_assert(offsetof(MarchWindow, tiles) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
