// Windows: depth without limit for rays that count in 32 bits.
//
// A window is the cube of the 2^3 tiles of one level that are nearest to the eye. There is one window per
// level, the finest first, each inside the next. A ray marches a window in voxels that are a fixed number of
// levels finer than its tiles, with positions relative to the window's low corner. Where the ray leaves the
// window it goes on in the next one: its distances are divided by N, which is exact, and so is the place of
// its voxel, because windows end where tiles do. So no voxel is crossed twice or left out, and a ray has the
// same precision, in voxels that its cone asks for, near the eye and far from it. Descents start at the
// window's tiles, not at the root, and take as many steps however deep the tree is. (The nesting is that of
// clip maps: Tanner, Migdal and Jones 1998.)
#include "interop/tile_query.h"
#include "interop/windows.h"
layout(std140, binding = UBO_WINDOWS) uniform WindowBlock {
    ivec4 count;
    MarchWindow of[MAX_WINDOWS];
} windows;

// The window of the voxel that the pixel shows most of.
int seen_window = 0;

// The window's tile around the ray: its entry, or WINDOW_*.
uint window_tile(Ray ray) {
    const ivec3 tile = cell_of(ray.cell, ROOT_SHIFT);
    return windows.of[ray.window].tiles[tile.z][tile.x + 2 * tile.y];
}

// Rank of a query for the window's tile around the ray.
int window_rank(Ray ray) {
    const ivec3 tile = cell_of(ray.cell, ROOT_SHIFT);
    return QUERY_RANK_WINDOWS + 8 * ray.window + tile.x + 2 * (tile.y + 2 * tile.z);
}

// Converts the ray to voxels of the next window.
void coarsen(inout Ray ray) {
    const ivec3 shift = windows.of[ray.window].shift;
    const float scale = 1.0 / float(TREE_N);
    ++ray.window;
    // The eye of each window is more exact than a conversion, which rounds in each window.
    ray.origin = ray.from_eye ? windows.of[ray.window].eye : ray.origin * scale + vec3(shift);
    ray.cell = cell_of(ray.cell, N_SHIFT) + shift;
    ray.t *= scale;
    ray.t_end *= scale;
    ray.cone_base *= scale;
}

// Goes on in the next window that holds the ray's voxel; false if there is none, or the ray has come to its
// end.
bool leave_window(inout Ray ray) {
    if (ray.t >= ray.t_end) return false;
    while (ray.window + 1 < windows.count.x) {
        coarsen(ray);
        if (all(greaterThanEqual(ray.cell, ivec3(0))) && all(lessThan(ray.cell, ivec3(MARCHED_SIDE)))) return true;
    }
    return false;
}

// Puts the ray into the first window that it meets, from the window that it is in on.
bool enter_windows(inout Ray ray) {
    while (!enter_root(ray)) {
        if (ray.window + 1 >= windows.count.x) return false;
        coarsen(ray);
    }
    return true;
}
