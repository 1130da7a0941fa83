// Pictures of the tree: colours by the level of a voxel, or by its place in its brick.
#include "interop/march.h"

vec3 level_color(float level) {
    const vec3 phase = vec3(LEVEL_PHASE_R, LEVEL_PHASE_G, LEVEL_PHASE_B);
    return 0.5 + 0.5 * cos(LEVEL_HUE * level + phase);
}

int first_level = 0;  // tree level of the cube that descents start from

// The tree level whose bricks have voxels of the sample's size; mips lie between two levels.
float level_of(Sample s) {
    const int shift = int(round(log2(s.voxel_side) / log2(float(CELL_BASE))));
    return float(first_level) + float(ROOT_SHIFT - TILE_SHIFT - shift) / float(N_SHIFT);
}

// An axis whose part in the normal is at least this share of the greatest part: the surface runs along the
// brick's sides across that axis.
#define ALONG_SIDE 0.98

// Whether the sample is near a side of its brick through which the surface leaves the brick. A side that the
// surface runs along does not count, or the surface would be marked all over.
bool near_brick_side(Sample s, vec3 normal) {
    const int last = MIP_M(s.mip) - 1;
    const vec3 across = abs(normal);
    const bvec3 along = greaterThanEqual(across, vec3(ALONG_SIDE * max(across.x, max(across.y, across.z))));
    const bvec3 near = bvec3(any(equal(ivec2(s.voxel.x), ivec2(0, last))),
                             any(equal(ivec2(s.voxel.y), ivec2(0, last))),
                             any(equal(ivec2(s.voxel.z), ivec2(0, last))));
    return any(bvec3(near.x && !along.x, near.y && !along.y, near.z && !along.z));
}

vec3 tree_color(Sample s, vec3 color, vec3 normal) {
    const vec3 of_level = level_color(level_of(s));
    if (view.shown == SHOW_LEVELS) return of_level;
    return near_brick_side(s, normal) ? of_level : color;
}
