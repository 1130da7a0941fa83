// A primitive as seen from one of the three directions, and the inputs of its fragments. Planes and sides are
// flat inputs, computed from exact vertices, and nothing is interpolated, so that neither the driver's
// snapping of vertices to parts of a pixel nor its clipping moves a slice.
//
//     CORNERS   corners of a primitive: 3, 2 or 1
//     COVER=0   OpenGL rasterizes the primitive itself
//     COVER=1   a triangle around it is rasterized, and fragments decide by its sides (Hasselgren et al. 2005)
//     AXES      directions that look at it: 3 = all, 1 = z alone, 0 = the one that sees it most squarely
//
//     Projection project(ivec3 corners[CORNERS], int axis)   corners on the lattice; axis of the direction
//     void put(Projection p, int corner, uint primitive)     writes the outputs of one vertex
#include "interop/voxelize.h"

#define VARYING out
#include "voxelize/slice_inputs.glsl"

uniform ivec3 tile_low;         // low corner of the tile, lattice units
uniform ivec3 region_end;       // high corner of the region, lattice units from tile_low
uniform int voxel_shift;
uniform int tall;               // the layer of x has y downwards, not z
// Half the longest side of the tile, in voxels: planes and sides are relative to the point with these
// coordinates.
uniform float tile_middle;
// Clip units per voxel: the viewport's side is a power of two, so that scaling is exact.
uniform float viewport_scale;
// 0.5: pixels count that touch the primitive; 0: pixels whose centre lies in it.
uniform float half_pixel;

// Distance in pixels by which a cover is enlarged, since snapping moves a vertex by up to 1/256 of a pixel.
const float COVER_MARGIN = 0.015625;
// Sine of an angle under which an enlarged corner would lie far off.
const float ACUTE = 0.2;

struct Projection {
    // Corners of the triangle, segment or point that is rasterized, voxels.
    vec2 corners[3];
    bool visible;        // there is something to rasterize
    vec3 plane;          // depth at (x, y) from the tile's middle: dot(plane, (x, y, 1))
    vec2 limits;         // least and greatest depth
    // Inside where dot(side, (x, y, 1)) >= 0; |side.x| + |side.y| = 1.
    vec3 sides[3];
    vec4 box;            // low and high corner of the primitive, from the tile's middle
    // Weights of the second and third corner at (x, y): dot(weight, (x, y, 1)).
    vec3 weight_b, weight_c;
};

// A point turned so that x and y span the plane that a direction looks at, and z is the depth.
ivec3 turned(ivec3 p, int axis) {
    if (axis == 0) return tall != 0 ? p.zyx : p.yzx;
    return axis == 1 ? p.xzy : p;
}

int dominant_axis(ivec3 corners[CORNERS]) {
#if CORNERS == 3
    const dvec3 n = abs(cross(dvec3(corners[1] - corners[0]), dvec3(corners[2] - corners[0])));
    return n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
#elif CORNERS == 2
    const ivec3 d = abs(corners[1] - corners[0]);
    return d.x < d.y && d.x < d.z ? 0 : d.y < d.z ? 1 : 2;
#else
    return 2;
#endif
}

// A linear function of the plane by its gradient and its value at a point.
vec3 linear(dvec2 gradient, dvec2 at, double value) {
    const dvec2 from_at = dvec2(tile_middle) - at;
    // Kept within 1e30, because floats end at 1e38.
    return vec3(clamp(dvec3(gradient, value + dot(gradient, from_at)), -1.0e30LF, 1.0e30LF));
}

vec3 side_through(dvec2 p, dvec2 q, bool flip) {
    dvec2 n = dvec2(p.y - q.y, q.x - p.x);
    const double size = abs(n.x) + abs(n.y);
    if (size == 0.0LF) return vec3(0.0, 0.0, 1.0);
    n /= flip ? -size : size;
    return linear(n, p, 0.0LF);
}

#if CORNERS == 3
void project_plane(inout Projection p, dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 ab = b - a, ac = c - a;
    const dvec3 n = cross(ab, ac);
    p.visible = n.z != 0.0LF;
    const double divisor = p.visible ? n.z : 1.0LF;
    p.plane = linear(-n.xy / divisor, a.xy, a.z);
    p.weight_b = linear(dvec2(ac.y, -ac.x) / divisor, a.xy, 0.0LF);
    p.weight_c = linear(dvec2(-ab.y, ab.x) / divisor, a.xy, 0.0LF);
    p.sides[0] = side_through(a.xy, b.xy, divisor < 0.0LF);
    p.sides[1] = side_through(b.xy, c.xy, divisor < 0.0LF);
    p.sides[2] = side_through(c.xy, a.xy, divisor < 0.0LF);
}
#else
// The depth along a segment, by the coordinate in which the segment is longer.
void project_segment(inout Projection p, dvec3 a, dvec3 b) {
    const dvec3 d = b - a;
    p.visible = CORNERS == 1 || d.xy != dvec2(0.0LF);
    const bool along_x = abs(d.x) >= abs(d.y);
    const double run = along_x ? d.x : d.y;
    const double share = run != 0.0LF ? 1.0LF / run : 0.0LF;
    const dvec2 gradient = along_x ? dvec2(share, 0.0LF) : dvec2(0.0LF, share);
    p.plane = linear(gradient * d.z, a.xy, a.z);
    p.weight_b = linear(gradient, a.xy, 0.0LF);
    p.weight_c = vec3(0.0);
    p.sides[0] = side_through(a.xy, b.xy, false);
    p.sides[1] = -p.sides[0] * (p.sides[0].xy == vec2(0.0) ? -1.0 : 1.0);
    p.sides[2] = vec3(0.0, 0.0, 1.0);
}
#endif

#if COVER
// Covers a rectangle, given by a corner and two edges, by a right triangle.
void cover_rectangle(inout Projection p, vec2 corner, vec2 u, vec2 v) {
    p.corners[0] = corner;
    p.corners[1] = corner + 2.0 * u;
    p.corners[2] = corner + 2.0 * v;
}

// Covers a needle, a segment or a point by the rectangle along its longest side.
void cover_needle(inout Projection p, vec2 a, vec2 b, vec2 c, float margin) {
    const vec2 ab = b - a, bc = c - b, ca = a - c;
    vec2 along = dot(ab, ab) >= dot(bc, bc) ? ab : bc;
    along = dot(along, along) >= dot(ca, ca) ? along : ca;
    const float size = length(along);
    along = size > 0.0 ? along / size : vec2(1.0, 0.0);
    const vec2 across = vec2(-along.y, along.x);
    const float reach = margin * (abs(along.x) + abs(along.y));
    const vec3 u = vec3(0.0, dot(ab, along), -dot(ca, along));
    const vec3 v = vec3(0.0, dot(ab, across), -dot(ca, across));
    const vec2 low = vec2(min(min(u.x, u.y), u.z), min(min(v.x, v.y), v.z)) - reach;
    const vec2 high = vec2(max(max(u.x, u.y), u.z), max(max(v.x, v.y), v.z)) + reach;
    cover_rectangle(p, a + low.x * along + low.y * across, (high.x - low.x) * along, (high.y - low.y) * across);
}

// The crossing of two sides that are moved outwards, relative to the corner between them (Hasselgren et al.
// 2005, section 2.2).
vec2 moved_corner(vec3 before, vec3 after, float margin) {
    const float sine = before.x * after.y - before.y * after.x;
    return vec2(before.y - after.y, after.x - before.x) * (margin / sine);
}

bool is_acute(vec3 before, vec3 after) { return abs(before.x * after.y - before.y * after.x) < ACUTE; }

// Finds a triangle that covers all pixels that the primitive touches. Fragments mark nothing in the other
// pixels that it covers.
void cover(inout Projection p, vec2 a, vec2 b, vec2 c) {
    const float margin = half_pixel + COVER_MARGIN;
    const vec2 low = min(min(a, b), c) - margin, high = max(max(a, b), c) + margin;
    if (any(lessThan(low, vec2(-RASTER_FAR_VOXELS))) || any(greaterThan(high, vec2(2 * RASTER_FAR_VOXELS)))) {
        // The primitive is too wide for the driver's clipping: its box inside the tile is drawn.
        const vec2 corner = max(low, vec2(0.0));
        const vec2 size = min(high, vec2(2.0 * tile_middle)) - corner;
        p.visible = p.visible && all(greaterThan(size, vec2(0.0)));
        cover_rectangle(p, corner, vec2(size.x, 0.0), vec2(0.0, size.y));
    } else if (CORNERS < 3 || is_acute(p.sides[2], p.sides[0]) || is_acute(p.sides[0], p.sides[1]) ||
               is_acute(p.sides[1], p.sides[2])) {
        cover_needle(p, a, b, c, margin);
    } else {
        p.corners[0] = a + moved_corner(p.sides[2], p.sides[0], margin);
        p.corners[1] = b + moved_corner(p.sides[0], p.sides[1], margin);
        p.corners[2] = c + moved_corner(p.sides[1], p.sides[2], margin);
    }
}
#endif

Projection project(ivec3 corners[CORNERS], int axis) {
    const ivec3 a = turned(corners[0] - tile_low, axis);
    const ivec3 b = turned(corners[min(1, CORNERS - 1)] - tile_low, axis);
    const ivec3 c = turned(corners[CORNERS - 1] - tile_low, axis);
    const double unit = 1.0LF / double(1 << voxel_shift);
    const float voxels = float(unit);
    Projection p;
#if CORNERS == 3
    project_plane(p, dvec3(a) * unit, dvec3(b) * unit, dvec3(c) * unit);
#else
    project_segment(p, dvec3(a) * unit, dvec3(b) * unit);
#endif
    const ivec3 low = min(min(a, b), c), high = max(max(a, b), c);
    p.limits = vec2(low.z, high.z) * voxels;
    // A primitive in the region's end, with no voxel behind it, belongs to the last voxel.
    if (low.z == high.z && low.z == turned(region_end, axis).z) p.limits -= 0.5;
    p.box = vec4(low.xy, high.xy) * voxels - tile_middle;
#if COVER
    cover(p, vec2(a.xy) * voxels, vec2(b.xy) * voxels, vec2(c.xy) * voxels);
#else
    p.corners[0] = vec2(a.xy) * voxels;
    p.corners[1] = vec2(b.xy) * voxels;
    p.corners[2] = vec2(c.xy) * voxels;
#endif
    return p;
}

void put(Projection p, int corner, uint primitive) {
    slice_plane = p.plane;
    slice_limits = p.limits;
    slice_side_a = p.sides[0];
    slice_side_b = p.sides[1];
    slice_side_c = p.sides[2];
    slice_box = p.box;
    slice_weight_b = p.weight_b;
    slice_weight_c = p.weight_c;
    slice_primitive = primitive;
    // If the primitive is not visible, all corners are at one place outside the view. Depth clips nothing.
    const vec2 place = p.visible ? p.corners[corner] * viewport_scale - 1.0 : vec2(-2.0);
    gl_Position = vec4(place, 0.0, 1.0);
}
