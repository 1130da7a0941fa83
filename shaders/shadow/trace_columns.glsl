// A ray through the xy-reduced pyramid (Forest et al. 2009, section 3.1.1, after Revelles et al. 2000). The
// includer supplies visit_voxel().
//
// A column of some level is empty for a ray if none of its bits is set between the voxels where the ray
// enters and leaves it (the adaptive mask of Figure 10(b)): then the ray steps over the column, and goes on
// with the largest column that begins there. Otherwise the ray goes down a level; in a column of voxels, the
// bits that are set are the voxels that the ray meets. With COLUMN_MASK_MIP_LEVEL a node is a cube, as in
// Figure 10(a).
//
// The times at which a ray crosses planes, as floats, decide which voxels it crosses and in which order; of
// equal times, that of x comes first, then y, then z. So the result does not depend on the columns by which
// it is found, and every step moves one coordinate by at least one.
//
// Needs the defines COLUMN_LEVELS and COLUMN_MASK.
#include "interop/columns.h"

// The level at which a ray begins: it begins on a surface, where larger columns are not empty. From the root,
// where Forest et al. begin, the same voxels are found later.
#define COLUMN_START_LEVEL 2
#include "shadow/columns.glsl"

#define CELL_BASE 2
#define WINDOWS 0
#define MARCHED_SIDE COLUMN_SIDE
#include "march/cells.glsl"
#include "march/ray.glsl"

// Takes an occupied voxel that the ray crosses, and the distance of the middle of the ray's way through it;
// false ends the ray.
bool visit_voxel(ivec3 voxel, float t);

// The times at which the ray crosses these planes, one per axis; ENDLESS for an inert axis.
vec3 crossing_times(Ray ray, ivec3 planes) {
    precise vec3 t = (vec3(planes) - ray.origin) * ray.inverse;
    return mix(t, vec3(ENDLESS), ray.inert);
}

// The voxel where the ray is once it has crossed all planes before time t, and the planes at time t of the
// axes in `tied`. It lies between ray.cell and `last`.
ivec3 voxel_at(Ray ray, float t, bvec3 tied, ivec3 last) {
    const ivec3 low = min(ray.cell, last);
    const ivec3 high = max(ray.cell, last);
    const ivec3 guess = clamp(ivec3(floor(ray.origin + ray.direction * t)), low, high);
    // Rounding may have put the guess on the wrong side of a plane.
    const vec3 t_in = crossing_times(ray, guess + 1 - ray.positive);
    const vec3 t_out = crossing_times(ray, guess + ray.positive);
    const vec3 at = vec3(t);
    const ivec3 ahead = ivec3(lessThan(t_out, at)) | (ivec3(equal(t_out, at)) & ivec3(tied));
    const ivec3 behind = ivec3(greaterThan(t_in, at)) | (ivec3(equal(t_in, at)) & ivec3(not(tied)));
    const ivec3 moved = guess + (2 * ray.positive - 1) * (ahead - behind);
    return mix(clamp(moved, low, high), ray.cell, ray.inert);
}

// The ray's way through the node of a level around its voxel.
struct Crossed {
    // First x of the voxels that are tested, in the order of the ray.
    int from;
    int to;          // last x of the voxels that are tested
    int exit_axis;   // axis across whose plane the ray leaves
    float t_exit;    // time at which the ray leaves
    ivec3 last;      // the ray's last voxel in the node
};

Crossed cross_node(Ray ray, int level) {
#if COLUMN_MASK == COLUMN_MASK_MIP_LEVEL
    const ivec3 shift = ivec3(level);
#else
    const ivec3 shift = ivec3(COLUMN_LEVELS, level, level);
#endif
    const ivec3 low = (ray.cell >> shift) << shift;
    const ivec3 high = low + (ivec3(1) << shift) - 1;
    // The corner by which a ray would leave across all axes at once.
    const ivec3 corner = mix(low, high, equal(ray.positive, ivec3(1)));
    const vec3 t = crossing_times(ray, corner + ray.positive);
    Crossed way;
    const float t_plane = min(t.x, min(t.y, t.z));
    way.t_exit = max(t_plane, ray.t);
    way.exit_axis = t.x == t_plane ? 0 : t.y == t_plane ? 1 : 2;
    // The ray also crosses those planes at the time of its exit that belong to axes before the exit axis.
    const bool ends = way.t_exit >= ray.t_end;
    const bvec3 tied = bvec3(!ends, !ends && way.exit_axis > 1, false);
    way.last = voxel_at(ray, min(way.t_exit, ray.t_end), tied, corner);
    if (!ends) {
        if (way.exit_axis == 0) way.last.x = corner.x;
        if (way.exit_axis == 1) way.last.y = corner.y;
        if (way.exit_axis == 2) way.last.z = corner.z;
    }
#if COLUMN_MASK == COLUMN_MASK_MIP_LEVEL
    way.from = low.x;
    way.to = high.x;
#else
    way.from = ray.cell.x;
    way.to = way.last.x;
#endif
    return way;
}

// Moves the ray to the voxel behind the node, and finds the level of the largest node that begins there.
// False if the ray has left the grid or come to its end.
bool leave_node(inout Ray ray, Crossed way, out int level) {
    const ivec3 before = ray.cell;
    ray.cell = way.last;
    const ivec3 step = 2 * ray.positive - 1;
    if (way.exit_axis == 0) ray.cell.x += step.x;
    if (way.exit_axis == 1) ray.cell.y += step.y;
    if (way.exit_axis == 2) ray.cell.z += step.z;
    ray.t = way.t_exit;
    const uvec3 place = uvec3(ray.cell);
    if (max(place.x, max(place.y, place.z)) >= uint(COLUMN_SIDE) || ray.t >= ray.t_end) return false;
    const ivec3 differ = before ^ ray.cell;
#if COLUMN_MASK == COLUMN_MASK_MIP_LEVEL
    level = findMSB(differ.x | differ.y | differ.z);
#else
    level = findMSB(differ.y | differ.z);
#endif
    return true;
}

// Takes the voxel at `x` of the column of voxels that the ray is in, and moves the ray behind it within the
// column. `goes_on`: the result of visit_voxel(). False if it was the last voxel of the column on the ray's
// way.
bool take_voxel(inout Ray ray, Crossed way, int x, out bool goes_on) {
    const vec3 t_in = crossing_times(ray, ivec3(x + 1 - ray.positive.x));
    const vec3 t_out = crossing_times(ray, ivec3(x + ray.positive.x));
    const float t_enter = x == ray.cell.x ? ray.t : t_in.x;
    const bool is_last = x == way.last.x;
    const float t_leave = is_last ? way.t_exit : t_out.x;
    goes_on = visit_voxel(ivec3(x, ray.cell.yz), 0.5 * (t_enter + t_leave));
    if (is_last) return false;
    ray.cell.x = x + 2 * ray.positive.x - 1;
    ray.t = t_leave;
    return true;
}

// Traces the ray from ray.t on; true if visit_voxel() has ended it. `turns` counts the turns of the thread in
// this pass.
bool trace_columns(inout Ray ray, inout int turns) {
    if (!enter_root(ray)) return false;
    // Moves the voxel to the side of each plane that the ray is on at this time.
    const ivec3 entered = ray.cell;
    const ivec3 step = 2 * ray.positive - 1;
    ray.cell = clamp(entered - step, ivec3(0), ivec3(COLUMN_SIDE - 1));
    ray.cell = mix(voxel_at(ray, ray.t, bvec3(true), clamp(entered + step, ivec3(0), ivec3(COLUMN_SIDE - 1))), entered,
                    ray.inert);
    int level = min(COLUMN_START_LEVEL, COLUMN_LEVELS);
    for (;;) {
        ++turns;
        const Crossed way = cross_node(ray, level);
        const int found = first_occupied(column_at(level, ray.cell.yz >> level), way.from, way.to, turns);
        if (found < 0) {
            if (!leave_node(ray, way, level)) return false;
        } else if (level > 0) {
            --level;
        } else {
            bool goes_on;
            const bool stays = take_voxel(ray, way, found, goes_on);
            if (!goes_on) return true;
            if (!stays && !leave_node(ray, way, level)) return false;
        }
    }
}
