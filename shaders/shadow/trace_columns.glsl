// A ray through the xy-reduced pyramid (Forest et al. 2009, section 3.1.1, after Revelles et al. 2000). The
// includer supplies visit_voxel().
//
// A column of some level is empty for a ray when none of its bits is set between the voxels where the ray
// enters and leaves it (their adaptive mask, Figure 10(b)): then the ray steps over it, and goes on with the
// largest column that begins there. Otherwise it goes down a level, and in a column of voxels the bits that
// are set are the voxels that it meets. With COLUMN_MASK_MIP_LEVEL a node is a cube, as in Figure 10(a).
//
// Which voxels a ray crosses, and in which order, is told by the times at which it crosses their planes, as
// floats; of equal ones x comes first, then y, then z. So it does not depend on the columns by which it is
// found, and every step moves one coordinate by at least one.
//
// Needs the defines COLUMN_LEVELS and COLUMN_MASK.
#include "interop/columns.h"

// Where a ray begins: on a surface, where larger columns are not empty. From the root on, as Forest et al.
// begin, the same voxels are found later.
#define COLUMN_START_LEVEL 2
#include "shadow/columns.glsl"

#define CELL_BASE 2
#define WINDOWS 0
#define MARCHED_SIDE COLUMN_SIDE
#include "march/cells.glsl"
#include "march/ray.glsl"

// An occupied voxel that the ray crosses, and the distance of the middle of its way through it; false stops
// the ray.
bool visit_voxel(ivec3 voxel, float t);

// When the ray crosses these planes, one an axis; never those of an inert axis.
vec3 crossing_times(Ray ray, ivec3 planes) {
    precise vec3 t = (vec3(planes) - ray.origin) * ray.inverse;
    return mix(t, vec3(ENDLESS), ray.inert);
}

// The voxel where the ray is once it has crossed all planes before time t, and of those at t the axes in
// `tied`. It lies between ray.voxel and `last`.
ivec3 voxel_at(Ray ray, float t, bvec3 tied, ivec3 last) {
    const ivec3 low = min(ray.voxel, last);
    const ivec3 high = max(ray.voxel, last);
    const ivec3 guess = clamp(ivec3(floor(ray.origin + ray.direction * t)), low, high);
    // Rounding may have put it on the wrong side of a plane.
    const vec3 t_in = crossing_times(ray, guess + 1 - ray.positive);
    const vec3 t_out = crossing_times(ray, guess + ray.positive);
    const vec3 at = vec3(t);
    const ivec3 ahead = ivec3(lessThan(t_out, at)) | (ivec3(equal(t_out, at)) & ivec3(tied));
    const ivec3 behind = ivec3(greaterThan(t_in, at)) | (ivec3(equal(t_in, at)) & ivec3(not(tied)));
    const ivec3 moved = guess + (2 * ray.positive - 1) * (ahead - behind);
    return mix(clamp(moved, low, high), ray.voxel, ray.inert);
}

// The ray's way through the node of a level around its voxel.
struct Crossed {
    int from;        // x of the voxels that are tested, in the order of the ray
    int to;
    int exit_axis;   // whose plane it leaves by
    float t_exit;
    ivec3 last;      // its last voxel in the node
};

Crossed cross_node(Ray ray, int level) {
#if COLUMN_MASK == COLUMN_MASK_MIP_LEVEL
    const ivec3 shift = ivec3(level);
#else
    const ivec3 shift = ivec3(COLUMN_LEVELS, level, level);
#endif
    const ivec3 low = (ray.voxel >> shift) << shift;
    const ivec3 high = low + (ivec3(1) << shift) - 1;
    // Where it leaves by all axes at once.
    const ivec3 corner = mix(low, high, equal(ray.positive, ivec3(1)));
    const vec3 t = crossing_times(ray, corner + ray.positive);
    Crossed way;
    const float t_plane = min(t.x, min(t.y, t.z));
    way.t_exit = max(t_plane, ray.t);
    way.exit_axis = t.x == t_plane ? 0 : t.y == t_plane ? 1 : 2;
    // Planes that it crosses at the same time as the one by which it leaves: those of the axes before that
    // one.
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
    way.from = ray.voxel.x;
    way.to = way.last.x;
#endif
    return way;
}

// Brings the ray to the voxel behind the node, and tells the level of the largest node that begins there.
// False when it has left the grid or come to its end.
bool leave_node(inout Ray ray, Crossed way, out int level) {
    const ivec3 before = ray.voxel;
    ray.voxel = way.last;
    const ivec3 step = 2 * ray.positive - 1;
    if (way.exit_axis == 0) ray.voxel.x += step.x;
    if (way.exit_axis == 1) ray.voxel.y += step.y;
    if (way.exit_axis == 2) ray.voxel.z += step.z;
    ray.t = way.t_exit;
    const uvec3 place = uvec3(ray.voxel);
    if (max(place.x, max(place.y, place.z)) >= uint(COLUMN_SIDE) || ray.t >= ray.t_end) return false;
    const ivec3 differ = before ^ ray.voxel;
#if COLUMN_MASK == COLUMN_MASK_MIP_LEVEL
    level = findMSB(differ.x | differ.y | differ.z);
#else
    level = findMSB(differ.y | differ.z);
#endif
    return true;
}

// Takes the voxel at x = `x` of the column of voxels that the ray is in, and brings the ray behind it within
// the column. `goes_on`: visit_voxel() wants more. False when it was the column's last on the ray's way.
bool take_voxel(inout Ray ray, Crossed way, int x, out bool goes_on) {
    const vec3 t_in = crossing_times(ray, ivec3(x + 1 - ray.positive.x));
    const vec3 t_out = crossing_times(ray, ivec3(x + ray.positive.x));
    const float t_enter = x == ray.voxel.x ? ray.t : t_in.x;
    const bool is_last = x == way.last.x;
    const float t_leave = is_last ? way.t_exit : t_out.x;
    goes_on = visit_voxel(ivec3(x, ray.voxel.yz), 0.5 * (t_enter + t_leave));
    if (is_last) return false;
    ray.voxel.x = x + 2 * ray.positive.x - 1;
    ray.t = t_leave;
    return true;
}

// From ray.t on; true when visit_voxel() has stopped the ray. `turns` counts what a thread has done in this
// pass.
bool trace_columns(inout Ray ray, inout int turns) {
    if (!enter_root(ray)) return false;
    // Onto the side of each plane that the ray is on at this time.
    const ivec3 entered = ray.voxel;
    const ivec3 step = 2 * ray.positive - 1;
    ray.voxel = clamp(entered - step, ivec3(0), ivec3(COLUMN_SIDE - 1));
    ray.voxel = mix(voxel_at(ray, ray.t, bvec3(true), clamp(entered + step, ivec3(0), ivec3(COLUMN_SIDE - 1))), entered,
                    ray.inert);
    int level = min(COLUMN_START_LEVEL, COLUMN_LEVELS);
    for (;;) {
        ++turns;
        const Crossed way = cross_node(ray, level);
        const int found = first_occupied(column_at(level, ray.voxel.yz >> level), way.from, way.to, turns);
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
