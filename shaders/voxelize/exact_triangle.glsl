// Which voxels a closed triangle meets: exact on every driver.
//
//     ExactTriangle exact_triangle(ivec3 a, ivec3 b, ivec3 c, int shift)
//         vertices on the lattice, within [-2^24, 2^25]; voxel side 2^shift lattice units
//     t.low, t.high
//         inclusive box of the voxels that its bounding box touches
//     ivec2 row_span(ExactTriangle t, ivec2 row)
//         the voxels of row (y, z) that it touches: an inclusive interval of x, within t.low.x and t.high.x; empty if
//         its x > its y. The row must lie within t.low.yz and t.high.yz.
//
//     ivec2 filtered_row_span(ExactTriangle t, ivec2 row, out bool in_doubt)
//     ivec2 exact_row_span(ExactTriangle t, ivec2 row)
//         the two tiers of row_span(), for hot loops: a driver whose lanes run in lockstep may compute the second tier
//         for all lanes, so it is better to gather rows in doubt and decide them apart (mark_large)
//
// Voxels are numbered in the whole root cube: voxel i spans [i, i + 1] * 2^shift. Boxes and triangles are
// closed: contact counts. Segments and points are triangles too.
//
// Needs the define ANY_VOXEL_SIDE. If it is 1, `shift` is instead the voxel's side in lattice units, even and
// at most 2^24 (for trees whose N is not a power of two), and the functions that step through rows are left
// out.
//
// Separating axes: Akenine-Möller 2001. Each axis that has an x component bounds x from one side by a linear
// function of the row; the other axes accept or reject the row (Schwarz and Seidel 2010, section 3). A
// projection without area is replaced by its longest side, there and back, so that both sides of its axis are
// tested.
//
// Two tiers. The filter works in float, from the corner t.low, in units in which vertices and planes are
// exact: voxels (lattice units with ANY_VOXEL_SIDE: all planes within the box are even numbers under 2^25). u
// = 2^-24 is the unit of rounding. Every bound is known to +-error; if the two ends of that range do not give
// the same voxels, the row is in doubt. Then the exact tier decides in double: each product and sum below is
// a whole number of at most 2^53 and thus exact, fused or not. Edges are under 2^25.6, distances under 2^26,
// and a component of the normal is at most 9 * 2^48, because twice the area of a triangle is at most that of
// its bounding box.

const float FAR_AWAY = 1.0e30;
const float SIDE_ERROR = 1.9073486328125e-6;    // 2^-19
const double SPLIT = 67108864.0LF;              // 2^26

// The three sides of a projection that has an x axis, as bounds of x: at rows [r, r + 1] the bound nearest to
// the triangle's outside is x - slope * (r - row).
struct SideBounds {
    vec3 x, row, slope;
    bvec3 is_lower, is_upper;  // neither: parallel to x, where the bounding box bounds as much
};

struct ExactTriangle {
    ivec3 a, b, c;
    ivec3 low, high;
#if ANY_VOXEL_SIDE
    int side;
#else
    int shift;
#endif
    dvec3 normal;       // (b - a) x (c - a)

    // false: the triangle is too wide for floats, and every row is in doubt.
    bool filtered;
    // Side * (y, z, 1) >= 0 where a row meets the inside of a side, +-SIDE_ERROR.
    vec3 side_y, side_z, side_offset;
    SideBounds xy, xz;
    float side_bounds_error;
    vec3 plane;         // lowest x of the plane over a row: plane * (y, z, 1)
    float plane_width;  // highest minus lowest x of the plane over a row
    float plane_error;
    bool has_plane;     // false: the plane is parallel to x
};

// The side and the low planes of a voxel, in lattice units; and the voxel that a point of the lattice lies
// in.
#if ANY_VOXEL_SIDE
int side_of(ExactTriangle t) { return t.side; }
int plane_of(ExactTriangle t, int voxel) { return voxel * t.side; }
ivec2 plane_of(ExactTriangle t, ivec2 voxel) { return voxel * t.side; }
ivec3 plane_of(ExactTriangle t, ivec3 voxel) { return voxel * t.side; }
ivec3 voxel_at(ExactTriangle t, ivec3 place) {
    const int across = (1 << 24) / t.side + 1;  // quotients of negative numbers are not defined
    return (place + across * t.side) / t.side - across;
}
#else
int side_of(ExactTriangle t) { return 1 << t.shift; }
int plane_of(ExactTriangle t, int voxel) { return voxel << t.shift; }
ivec2 plane_of(ExactTriangle t, ivec2 voxel) { return voxel << t.shift; }
ivec3 plane_of(ExactTriangle t, ivec3 voxel) { return voxel << t.shift; }
ivec3 voxel_at(ExactTriangle t, ivec3 place) { return place >> t.shift; }
#endif

// A lattice unit and the side of a voxel in the filter's units, and lengths in the filter's units in voxels.
#if ANY_VOXEL_SIDE
float lattice_unit(ExactTriangle t) { return 1.0; }
float voxel_unit(ExactTriangle t) { return float(t.side); }
vec2 in_voxels(ExactTriangle t, vec2 x) { return x / float(t.side); }
vec4 in_voxels(ExactTriangle t, vec4 x) { return x / float(t.side); }
// A quotient adds a rounding of up to 5 u, of values under the reach that the error is computed from.
#define PLANE_ERROR (0.75 * SIDE_ERROR)
#else
float lattice_unit(ExactTriangle t) { return 1.0 / float(1 << t.shift); }
float voxel_unit(ExactTriangle t) { return 1.0; }
vec2 in_voxels(ExactTriangle t, vec2 x) { return x; }
vec4 in_voxels(ExactTriangle t, vec4 x) { return x; }
#define PLANE_ERROR (0.5 * SIDE_ERROR)
#endif

// Orders a projected triangle counter-clockwise: (-edge.y, edge.x) then points inwards. A triangle without
// area is replaced by its longest side, there and back.
void wind(inout ivec2 a, inout ivec2 b, inout ivec2 c, double twice_area) {
    if (twice_area > 0.0LF) return;
    if (twice_area < 0.0LF) {
        const ivec2 swapped = b;
        b = c;
        c = swapped;
        return;
    }
    const ivec2 ab = abs(b - a), bc = abs(c - b), ca = abs(a - c);
    const int length_ab = ab.x + ab.y, length_bc = bc.x + bc.y, length_ca = ca.x + ca.y;
    if (length_ab < max(length_bc, length_ca)) {
        if (length_bc >= length_ca) a = c;
        else b = c;
    }
    c = a;
}

// ---- The filter ----

// The sides of a projection, counter-clockwise: edges a to b, b to c, c to a. Each argument is one component
// of all three edges.
SideBounds side_bounds(vec3 x, vec3 row, vec3 next_x, vec3 next_row, float voxel) {
    SideBounds s;
    const vec3 inward_x = row - next_row;
    const vec3 inward_row = next_x - x;
    s.is_lower = greaterThan(inward_x, vec3(0.0));
    s.is_upper = lessThan(inward_x, vec3(0.0));
    // The row's edge that is furthest inwards is r + 1 where the side faces up.
    s.slope = inward_row / mix(inward_x, vec3(1.0), equal(inward_x, vec3(0.0)));
    s.x = x;
    s.row = row - voxel * vec3(greaterThan(inward_row, vec3(0.0)));
    return s;
}

void prepare_sides(inout ExactTriangle t, vec3 y, vec3 z, vec3 next_y, vec3 next_z, vec2 size) {
    t.side_y = z - next_z;
    t.side_z = next_y - y;
    // Scaled, so that one error serves all. Each of the terms, and their partial sums, are within +-2 after
    // scaling, and at most ten roundings meet: 20 u < SIDE_ERROR.
    const vec3 reach = abs(t.side_y) * size.x + abs(t.side_z) * size.y;
    const bvec3 empty = equal(reach, vec3(0.0));
    const vec3 scale = 1.0 / mix(reach, vec3(1.0), empty);
    const vec3 nearest_y = y - voxel_unit(t) * vec3(greaterThan(t.side_y, vec3(0.0)));
    const vec3 nearest_z = z - voxel_unit(t) * vec3(greaterThan(t.side_z, vec3(0.0)));
    t.side_offset = mix(-(t.side_y * nearest_y + t.side_z * nearest_z) * scale, vec3(1.0), empty);
    t.side_y *= scale;
    t.side_z *= scale;
}

void prepare_plane(inout ExactTriangle t, vec3 a, vec3 size) {
    t.has_plane = t.normal.x != 0.0LF;
    const double divisor = t.has_plane ? t.normal.x : 1.0LF;
    const vec2 slope = vec2(t.normal.yz / divisor);
    const vec2 nearest = a.yz - voxel_unit(t) * vec2(greaterThan(slope, vec2(0.0)));
    t.plane = vec3(-slope, a.x + slope.x * nearest.x + slope.y * nearest.y);
    t.plane_width = voxel_unit(t) * (abs(slope.x) + abs(slope.y));
    // Terms and partial sums are within twice this reach; at most eight roundings meet: 16 u.
    t.plane_error = PLANE_ERROR * (size.x + abs(slope.x) * size.y + abs(slope.y) * size.z);
}

void prepare_filter(inout ExactTriangle t) {
    const ivec3 corner = plane_of(t, t.low);
    const ivec3 furthest = max(max(t.a, t.b), t.c) - corner;
    t.filtered = max(max(furthest.x, furthest.y), furthest.z) <= 1 << 24;

    const float unit = lattice_unit(t);
    const float voxel = voxel_unit(t);
    const vec3 size = voxel * vec3(t.high - t.low + 1);
    ivec2 a = t.a.yz - corner.yz, b = t.b.yz - corner.yz, c = t.c.yz - corner.yz;
    wind(a, b, c, t.normal.x);
    vec3 u = vec3(a.x, b.x, c.x) * unit, v = vec3(a.y, b.y, c.y) * unit;
    prepare_sides(t, u, v, u.yzx, v.yzx, size.yz + voxel);

    a = t.a.xy - corner.xy, b = t.b.xy - corner.xy, c = t.c.xy - corner.xy;
    wind(a, b, c, t.normal.z);
    u = vec3(a.x, b.x, c.x) * unit, v = vec3(a.y, b.y, c.y) * unit;
    t.xy = side_bounds(u, v, u.yzx, v.yzx, voxel);

    a = t.a.xz - corner.xz, b = t.b.xz - corner.xz, c = t.c.xz - corner.xz;
    wind(a, b, c, -t.normal.y);
    u = vec3(a.x, b.x, c.x) * unit, v = vec3(a.y, b.y, c.y) * unit;
    t.xz = side_bounds(u, v, u.yzx, v.yzx, voxel);
    // A bound within three sizes of the box is a vertex's x, plus a product of at most four sizes that has
    // met eight roundings: 35 u; from units to voxels, 15 u more. What is further out stays out.
    t.side_bounds_error = 2.0 * SIDE_ERROR * size.x;

    prepare_plane(t, vec3(t.a - corner) * unit, size + voxel);
}

vec2 bounds_at(SideBounds s, float row) {
    const vec3 x = s.x - s.slope * (row - s.row);
    const vec3 lower = mix(vec3(-FAR_AWAY), x, s.is_lower);
    const vec3 upper = mix(vec3(FAR_AWAY), x, s.is_upper);
    return vec2(max(max(lower.x, lower.y), lower.z), min(min(upper.x, upper.y), upper.z));
}

// The values that all rows of one z have in common.
struct RowSlice {
    vec3 side;     // side_z * z + side_offset, without the term of y
    vec2 xz;       // bounds of x
    float plane;   // plane.y * z + plane.z, without the term of y
};

RowSlice row_slice(ExactTriangle t, int z) {
    const float r = float(z - t.low.z) * voxel_unit(t);
    return RowSlice(t.side_z * r + t.side_offset, bounds_at(t.xz, r), t.plane.y * r + t.plane.z);
}

#if !ANY_VOXEL_SIDE
// The first and last whole r that may have slope * r + rest >= -SIDE_ERROR for all three sides. For triangles
// that are `filtered`.
vec2 rows_inside_sides(vec3 slope, vec3 rest) {
    // Twice the error, and some slack, allow for the roundings here.
    const vec3 bound = -(rest + 2.0 * SIDE_ERROR) / mix(slope, vec3(1.0), equal(slope, vec3(0.0)));
    const vec3 slack = 0.01 + 1.0e-6 * abs(bound);
    const vec3 low = mix(vec3(-FAR_AWAY), bound - slack, greaterThan(slope, vec3(0.0)));
    const vec3 high = mix(vec3(FAR_AWAY), bound + slack, lessThan(slope, vec3(0.0)));
    return vec2(ceil(max(max(low.x, low.y), low.z)), floor(min(min(high.x, high.y), high.z)));
}

// The first and last y of the rows of a slice that the triangle may meet.
ivec2 rows_of_slice(ExactTriangle t, RowSlice slice) {
    if (!t.filtered) return ivec2(t.low.y, t.high.y);
    const vec2 rows = rows_inside_sides(t.side_y, slice.side);
    const float last = float(t.high.y - t.low.y);
    return t.low.y + ivec2(clamp(rows.x, 0.0, last + 1.0), clamp(rows.y, -1.0, last));
}
#endif

// The span of the row at y in a slice; or the row is in doubt.
ivec2 filtered_row_span(ExactTriangle t, RowSlice slice, int y, out bool in_doubt) {
    const float r = float(y - t.low.y) * voxel_unit(t);
    const vec3 sides = t.side_y * r + slice.side;
    const float side = min(min(sides.x, sides.y), sides.z);

    const vec2 xy = bounds_at(t.xy, r);
    const vec2 bounds = vec2(max(xy.x, slice.xz.x), min(xy.y, slice.xz.y));
    const float plane_low = t.has_plane ? t.plane.x * r + slice.plane : -FAR_AWAY;
    const float plane_high = t.has_plane ? plane_low + t.plane_width : FAR_AWAY;
    const vec2 widest = in_voxels(t, vec2(max(bounds.x - t.side_bounds_error, plane_low - t.plane_error),
                                          min(bounds.y + t.side_bounds_error, plane_high + t.plane_error)));
    const vec2 narrowest = in_voxels(t, vec2(max(bounds.x + t.side_bounds_error, plane_low + t.plane_error),
                                             min(bounds.y - t.side_bounds_error, plane_high - t.plane_error)));
    // Closed voxel i touches [x, ...) from i = ceil(x) - 1 on.
    const float last = float(t.high.x - t.low.x);
    const vec2 least = vec2(0.0, -1.0), most = vec2(last + 1.0, last);
    const vec2 wide = clamp(vec2(ceil(widest.x) - 1.0, floor(widest.y)), least, most);
    const vec2 narrow = clamp(vec2(ceil(narrowest.x) - 1.0, floor(narrowest.y)), least, most);
    const bool outside = side < -SIDE_ERROR || wide.x > wide.y;
    in_doubt = !t.filtered || (!outside && (side < SIDE_ERROR || wide != narrow));
    return outside ? ivec2(1, 0) : ivec2(wide) + t.low.x;
}

ivec2 filtered_row_span(ExactTriangle t, ivec2 row, out bool in_doubt) {
    return filtered_row_span(t, row_slice(t, row.y), row.x, in_doubt);
}

// ---- The exact tier ----

// Whether the row meets the inner side of the edge from p to q, both (y, z).
bool meets_side(ivec2 p, ivec2 q, ivec2 row_low, int voxel_side) {
    const ivec2 inward = ivec2(p.y - q.y, q.x - p.x);
    const ivec2 innermost = row_low + voxel_side * ivec2(greaterThan(inward, ivec2(0)));
    return double(inward.x) * double(innermost.x - p.x) + double(inward.y) * double(innermost.y - p.y) >= 0.0LF;
}

// Narrows a span of x by the edge from p to q, both (x, row), for the row from row_low.
void narrow_by_side(inout ivec2 span, ExactTriangle t, ivec2 p, ivec2 q, int row_low) {
    const ivec2 inward = ivec2(p.y - q.y, q.x - p.x);
    if (inward.x == 0) return;
    const int innermost = row_low + (inward.y > 0 ? side_of(t) : 0);
    const double slope = double(inward.x);
    const double rest = double(inward.y) * double(innermost - p.y);
    // Finds the voxel plane nearest to the bound, then decides exactly on which side of it the bound lies.
    const double bound = (double(p.x) - rest / slope) / double(side_of(t));
    const int nearest = int(round(clamp(bound, double(t.low.x), double(t.high.x + 1))));
    const bool inside = slope * double(plane_of(t, nearest) - p.x) + rest >= 0.0LF;
    if (inward.x > 0) span.x = max(span.x, inside ? nearest - 1 : nearest);
    else span.y = min(span.y, inside ? nearest : nearest - 1);
}

// Narrows a span of x by the plane. The terms of the plane pass 53 bits, so the normal is split, n = high *
// SPLIT + low, with |high| < 2^25.2 and |low| <= 2^25. Three products of either half and a distance add up to
// less than 2^53.
void narrow_by_plane(inout ivec2 span, ExactTriangle t, ivec2 row_low) {
    if (t.normal.x == 0.0LF) return;
    const dvec3 normal = t.normal.x > 0.0LF ? t.normal : -t.normal;
    const dvec3 high = round(normal / SPLIT);
    const dvec3 low = normal - high * SPLIT;
    const int side = side_of(t);
    for (int end = 0; end < 2; ++end) {
        // Lower end: the first voxel whose upper corner is not under the plane. Upper end: the last voxel
        // whose lower corner is not above the plane.
        const bvec2 far_edge = end == 0 ? greaterThan(normal.yz, dvec2(0.0LF)) : lessThan(normal.yz, dvec2(0.0LF));
        const dvec2 d = dvec2(row_low + side * ivec2(far_edge) - t.a.yz);
        const double rest_high = high.y * d.x + high.z * d.y;
        const double rest_low = low.y * d.x + low.z * d.y;
        const double bound = (double(t.a.x) - (rest_high * SPLIT + rest_low) / normal.x) / double(side);
        const int nearest = int(round(clamp(bound, double(t.low.x), double(t.high.x + 1))));
        const double x = double(plane_of(t, nearest) - t.a.x);
        // The two values are compared and not added, because their sum would be rounded.
        const double value_high = (high.x * x + rest_high) * SPLIT;
        const double value_low = -(low.x * x + rest_low);
        if (end == 0) span.x = max(span.x, value_high >= value_low ? nearest - 1 : nearest);
        else span.y = min(span.y, value_high <= value_low ? nearest : nearest - 1);
    }
}

ivec2 exact_row_span(ExactTriangle t, ivec2 row) {
    const ivec2 row_low = plane_of(t, row);
    ivec2 a = t.a.yz, b = t.b.yz, c = t.c.yz;
    wind(a, b, c, t.normal.x);
    const int side = side_of(t);
    if (!meets_side(a, b, row_low, side) || !meets_side(b, c, row_low, side) || !meets_side(c, a, row_low, side)) {
        return ivec2(1, 0);
    }
    ivec2 span = ivec2(t.low.x, t.high.x);
    a = t.a.xy, b = t.b.xy, c = t.c.xy;
    wind(a, b, c, t.normal.z);
    narrow_by_side(span, t, a, b, row_low.x);
    narrow_by_side(span, t, b, c, row_low.x);
    narrow_by_side(span, t, c, a, row_low.x);
    a = t.a.xz, b = t.b.xz, c = t.c.xz;
    wind(a, b, c, -t.normal.y);
    narrow_by_side(span, t, a, b, row_low.y);
    narrow_by_side(span, t, b, c, row_low.y);
    narrow_by_side(span, t, c, a, row_low.y);
    narrow_by_plane(span, t, row_low);
    return span;
}

// ---- Functions for callers ----

ExactTriangle exact_triangle(ivec3 a, ivec3 b, ivec3 c, int shift) {
    ExactTriangle t;
    t.a = a;
    t.b = b;
    t.c = c;
#if ANY_VOXEL_SIDE
    t.side = shift;
#else
    t.shift = shift;
#endif
    // A voxel that ends where the triangle begins is touched as well.
    t.low = voxel_at(t, min(min(a, b), c) - 1);
    t.high = voxel_at(t, max(max(a, b), c));
    const dvec3 ab = dvec3(b - a), ac = dvec3(c - a);
    t.normal = dvec3(ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x);
    prepare_filter(t);
    return t;
}

ivec2 row_span(ExactTriangle t, ivec2 row) {
    bool in_doubt;
    const ivec2 span = filtered_row_span(t, row, in_doubt);
    if (!in_doubt) return span;
    return exact_row_span(t, row);
}
