// One thread is one pair: a triangle, and some rows of a mip of a tile that it may touch. It finds the brick
// voxels that the triangle meets, exactly as the voxelizer does, marks their finer voxels, and adds the
// triangle's attributes to them.
#include "interop/produce.h"
#include "interop/surface.h"
#include "produce/pairs.glsl"
#include "produce/cell_sides.glsl"
#include "produce/row_marks.glsl"
#include "voxelize/surface.glsl"
#include "voxelize/surface_attributes.glsl"
#include "voxelize/surface_color.glsl"
#include "common/thread.glsl"

// The thread's triangle, for attributes. Floats suffice here, because exact_triangle.glsl decides which
// voxels are met. Lengths are in sides of a finer voxel, from the first vertex.
struct Patch {
    uvec3 vertices;
    SurfaceMaterial material;
    ivec3 corner;               // the first vertex, in lattice units
    vec3 edge1, edge2;
    float d11, d12, d22;        // scalar products of the edges
    vec3 normal;                // normal of the triangle; 0 if it has no area
    float area;
    vec3 low, size;             // its bounding box
    int axis;                   // the axis that it is most across
    // Changes of the weights of the second and third vertex on the triangle's plane, per length along the
    // two other axes.
    vec2 weights_u, weights_v;
    // Of the first vertex, and along the edges.
    vec2 texcoord, texcoord_edge1, texcoord_edge2;
    vec4 color, color_edge1, color_edge2;
};

// The two other axes and then the one that the triangle is most across.
vec3 turned(vec3 p, int axis) { return axis == 0 ? p.yzx : axis == 1 ? p.zxy : p; }

Patch make_patch(uvec3 vertices, SurfaceMaterial material, ivec3 a, ivec3 b, ivec3 c, float side) {
    Patch s;
    s.vertices = vertices;
    s.material = material;
    s.corner = a;
    s.edge1 = vec3(b - a) / side;
    s.edge2 = vec3(c - a) / side;
    s.d11 = dot(s.edge1, s.edge1);
    s.d12 = dot(s.edge1, s.edge2);
    s.d22 = dot(s.edge2, s.edge2);
    const vec3 n = cross(s.edge1, s.edge2);
    const float size = length(n);
    s.normal = size > 0.0 ? n / size : vec3(0.0);
    s.area = 0.5 * size;
    s.low = min(vec3(0.0), min(s.edge1, s.edge2));
    s.size = max(vec3(0.0), max(s.edge1, s.edge2)) - s.low;
    const vec3 across = abs(n);
    s.axis = across.x >= across.y && across.x >= across.z ? 0 : across.y >= across.z ? 1 : 2;
    const vec3 e1 = turned(s.edge1, s.axis);
    const vec3 e2 = turned(s.edge2, s.axis);
    const float twice = e1.x * e2.y - e1.y * e2.x;
    const float scale = twice != 0.0 ? 1.0 / twice : 0.0;
    s.weights_u = vec2(e2.y, -e1.y) * scale;
    s.weights_v = vec2(-e2.x, e1.x) * scale;
    s.texcoord = attribute_texcoord(vertices.x);
    s.texcoord_edge1 = attribute_texcoord(vertices.y) - s.texcoord;
    s.texcoord_edge2 = attribute_texcoord(vertices.z) - s.texcoord;
    s.color = attribute_color(vertices.x);
    s.color_edge1 = attribute_color(vertices.y) - s.color;
    s.color_edge2 = attribute_color(vertices.z) - s.color;
    return s;
}

SurfacePoint point_of(Patch s, vec2 w) { return SurfacePoint(s.vertices, vec3(1.0 - w.x - w.y, w)); }

// The point of the triangle under a point of space; a point that falls beside the triangle is moved to the
// triangle.
vec2 weights_under(Patch s, vec3 d) {
    const float p1 = dot(d, s.edge1);
    const float p2 = dot(d, s.edge2);
    const float area = s.d11 * s.d22 - s.d12 * s.d12;
    vec2 w = vec2(0.0);
    if (area > 0.0) {
        w = vec2(s.d22 * p1 - s.d12 * p2, s.d11 * p2 - s.d12 * p1) / area;
    } else if (s.d11 > 0.0) {
        w.x = p1 / s.d11;
    }
    w = clamp(w, 0.0, 1.0);
    return w / max(w.x + w.y, 1.0);
}

#if HAS_MASK
// Whether the alpha mask leaves surface at a point.
bool is_kept(Patch s, vec2 w) { return alpha_at(point_of(s, w), s.material) * ALPHA_SLACK >= s.material.alpha_cutoff; }
#endif

// The marks of the triangle in the 4^3 finer voxels of a voxel, whose low corner is `low`. `marks`: without its
// alpha mask. Under the centres of the finer voxels that are left, the mask leaves surface.
uvec2 kept_marks(Patch s, vec3 low, uvec2 marks) {
#if HAS_MASK
    if (!is_masked(s.material)) return marks;
    uvec2 kept = marks;
    for (uvec2 rest = marks; (rest.x | rest.y) != 0u;) {
        const bool in_low = rest.x != 0u;
        const int bit = findLSB(in_low ? rest.x : rest.y);
        const uvec2 mark = in_low ? uvec2(1u << bit, 0u) : uvec2(0u, 1u << bit);
        const vec3 centre = low + vec3(bit & 3, bit >> 2 & 3, (bit >> 4) + (in_low ? 0 : 2)) + 0.5;
        if (!is_kept(s, weights_under(s, centre))) kept &= ~mark;
        rest &= ~mark;
    }
    return kept;
#else
    return marks;
#endif
}

// Mean place of the marks, in finer voxels from the low corner of their voxel.
vec3 middle_of(uvec2 mask, float count) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        const uint x = 0x11111111u << i;
        const uint y = 0x000F000Fu << (4 * i);
        const uint z = i % 2 == 0 ? 0x0000FFFFu : 0xFFFF0000u;
        const uint in_z = i < 2 ? mask.x & z : mask.y & z;
        sum += (float(i) + 0.5) * vec3(bitCount(mask.x & x) + bitCount(mask.y & x),
                                       bitCount(mask.x & y) + bitCount(mask.y & y), bitCount(in_z));
    }
    return sum / count;
}

// Is the triangle smaller than a voxel?
bool is_small(Patch s) { return max(s.size.x, max(s.size.y, s.size.z)) < 4.0; }

#define LINE_SLACK 1e-3  // rounding errors of a place, in finer voxels

// The area of the triangle's part in a voxel whose low corner is `low`, in faces of a finer voxel. `count`
// marks are left of `all_marks`, those that a mask cuts away included.
float area_in_voxel(Patch s, vec3 low, float count, float all_marks) {
    const vec3 across = abs(s.normal);
    // A plane meets so many finer voxels per area.
    if (!is_small(s)) return count / max(across.x + across.y + across.z, 1.0);
    // Marks do not measure a triangle that is small; the share of its bounding box that lies in the voxel does.
    const vec3 inside = max(min(s.low + s.size, low + 4.0) - max(s.low, low), 0.0);
    const vec3 share = mix(vec3(1.0), inside / max(s.size, vec3(1e-20)), greaterThan(s.size, vec3(0.0)));
    return s.area * share.x * share.y * share.z * (count / all_marks);
}

#if HAS_COLOR
vec4 vertex_color(Patch s, vec2 w) { return s.color + w.x * s.color_edge1 + w.y * s.color_edge2; }

// Mean of the texture over a parallelogram around a point, whose sides are changes of the weights, in the
// point's vertex colour.
vec3 texture_around(Patch s, vec2 w, vec2 side_a, vec2 side_b) {
    const vec4 tint = vertex_color(s, w);
    return tint.rgb * texture_color(s.material, s.texcoord + w.x * s.texcoord_edge1 + w.y * s.texcoord_edge2,
                         side_a.x * s.texcoord_edge1 + side_a.y * s.texcoord_edge2,
                         side_b.x * s.texcoord_edge1 + side_b.y * s.texcoord_edge2, tint.a);
}

#define SMALL_SIDE 0.35355339  // of a parallelogram as large as a quarter of a triangle

// Mean of the texture over the part, sampled at 2^2 points.
//
// Those of a large triangle are where it meets middle lines of the voxel's quarters along the axis that it
// is most across. Each sample stands for the parallelogram of the triangle's plane over its quarter, so that
// together they tile the part. Those of a triangle that is smaller than the voxel are the middles of the
// triangle's four quarters. If none lies in the voxel, the part is sampled at `middle`.
vec3 texture_in_voxel(Patch s, vec3 low, vec2 middle, float area) {
    const vec3 first = turned(low, s.axis);
    const vec2 start = first.x * s.weights_u + first.y * s.weights_v;
    const bool small = is_small(s);
    const vec2 side_a = small ? vec2(SMALL_SIDE, 0.0) : 2.0 * s.weights_u;
    const vec2 side_b = small ? vec2(0.0, SMALL_SIDE) : 2.0 * s.weights_v;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        const vec2 odd = vec2(i & 1, i >> 1);
        const vec2 quarter = i == 0 ? vec2(1.0 / 3.0) : i == 1 ? vec2(2.0, 0.5) / 3.0 : i == 2 ? vec2(0.5, 2.0) / 3.0
                                                                                             : vec2(0.5) / 3.0;
        const vec2 w = small ? quarter : start + (1.0 + 2.0 * odd.x) * s.weights_u + (1.0 + 2.0 * odd.y) * s.weights_v;
        if (w.x < 0.0 || w.y < 0.0 || w.x + w.y > 1.0) continue;
        const vec3 place = w.x * s.edge1 + w.y * s.edge2 - low;
        if (any(lessThan(place, vec3(-LINE_SLACK))) || any(greaterThan(place, vec3(4.0 + LINE_SLACK)))) continue;
#if HAS_MASK
        if (is_masked(s.material) && !is_kept(s, w)) continue;
#endif
        sum += vec4(texture_around(s, w, side_a, side_b), 1.0);
    }
    if (sum.a > 0.0) return sum.rgb / sum.a;
    // About half of the part's extent.
    const float shrunk = small ? 1.0 : 0.5 * min(2.0, sqrt(area));
    return texture_around(s, middle, shrunk * side_a, shrunk * side_b);
}
#endif

// A place in the voxel near which the triangle is shown.
vec3 shown_place(Patch s, uvec2 mask, float count) {
#if HAS_MASK
    if (is_masked(s.material)) {  // the middle may lie in a hole; the middles of marks do not
        const int mark = mask.x != 0u ? findLSB(mask.x) : 32 + findLSB(mask.y);
        return vec3(mark & 3, mark >> 2 & 3, mark >> 4) + 0.5;
    }
#endif
    return middle_of(mask, count);
}

// Adds the triangle's part in a voxel. `low`: the voxel's low corner; `voxel`: its number in the scratch.
void splat(Patch s, vec3 low, uint voxel, uvec2 marks) {
    const uvec2 mask = kept_marks(s, low, marks);
    if ((mask.x | mask.y) == 0u) return;
    const float all_marks = float(bitCount(marks.x) + bitCount(marks.y));
    const float count = float(bitCount(mask.x) + bitCount(mask.y));
    if (mask.x != 0u) atomicOr(scratch[2u * voxel], mask.x);
    if (mask.y != 0u) atomicOr(scratch[2u * voxel + 1u], mask.y);
    const float area = area_in_voxel(s, low, count, all_marks);
    const float weight = max(round(area * WEIGHT_UNIT), 1.0);
    const uint sums = sums_offset + voxel * uint(SUM_WORDS);
    if (atomicAdd(scratch[sums + SUM_WEIGHT], uint(weight)) > WEIGHT_LIMIT) return;

    const vec2 middle = weights_under(s, low + shown_place(s, mask, count));
    // Two's complement: negative sums wrap and come out right.
    const vec3 normal = normal_at(point_of(s, middle), s.normal);
    const vec3 weighted = normal * (weight * NORMAL_UNIT);
    const ivec3 n = ivec3(round(weighted));
    atomicAdd(scratch[sums + SUM_NORMAL], uint(n.x));
    atomicAdd(scratch[sums + SUM_NORMAL + 1], uint(n.y));
    atomicAdd(scratch[sums + SUM_NORMAL + 2], uint(n.z));
    const ivec3 by_x = ivec3(round(weighted * normal.x));
    const ivec2 by_y = ivec2(round(weighted.yz * normal.y));
    atomicAdd(scratch[sums + SUM_MOMENTS], uint(by_x.x));
    atomicAdd(scratch[sums + SUM_MOMENTS + 1], uint(by_x.y));
    atomicAdd(scratch[sums + SUM_MOMENTS + 2], uint(by_x.z));
    atomicAdd(scratch[sums + SUM_MOMENTS + 3], uint(by_y.x));
    atomicAdd(scratch[sums + SUM_MOMENTS + 4], uint(by_y.y));
#if HAS_COLOR
    const vec3 color = s.material.base_color.rgb * (s.material.width == 0u ? vertex_color(s, middle).rgb
                                                                         : texture_in_voxel(s, low, middle, area));
    const uvec3 c = uvec3(round(clamp(color, 0.0, 1.0) * weight * COLOR_UNIT));
    atomicAdd(scratch[sums + SUM_COLOR], c.x);
    atomicAdd(scratch[sums + SUM_COLOR + 1], c.y);
    atomicAdd(scratch[sums + SUM_COLOR + 2], c.z);
#endif
}

// The voxels of each row of the thread, from the first voxel of the region on: first | end << 16.
uint spans[PAIR_MOST_ROWS];
int doubts[PAIR_MOST_ROWS];

uint packed_span(ivec2 span, ivec3 low, ivec3 high) {
    const int first = max(span.x, low.x) - low.x;
    const int end = min(span.y, high.x) - low.x + 1;
    return first < end ? uint(first) | uint(end) << 16 : 0u;
}

// Finds the spans of the rows. Those that the filter leaves in doubt are decided afterwards, because lanes run
// in lockstep: doubles for one lane cost all lanes dearly at every turn.
void find_spans(ExactTriangle t, ivec3 low, ivec3 high) {
    int doubt_count = 0;
    int row = 0;
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            bool in_doubt;
            spans[row] = packed_span(filtered_row_span(t, ivec2(y, z), in_doubt), low, high);
            if (in_doubt) doubts[doubt_count++] = row;
            ++row;
        }
    }
    const int across = high.y - low.y + 1;
    for (int i = 0; i < doubt_count; ++i) {
        const ivec2 yz = low.yz + ivec2(doubts[i] % across, doubts[i] / across);
        spans[doubts[i]] = packed_span(exact_row_span(t, yz), low, high);
    }
}

void main() {
    const uint i = thread_index();
    if (i >= pair_count) return;
    const PairRows part = pair_rows(i);
    const SurfaceTriangle triangle = surface_triangles[part.triangle];
    const ivec3 a = surface_position(triangle.vertices.x);
    const ivec3 b = surface_position(triangle.vertices.y);
    const ivec3 c = surface_position(triangle.vertices.z);
    const ExactTriangle coarse = exact_triangle(a, b, c, part.size);
    const ExactTriangle fine = exact_triangle(a, b, c, FINER(part.size));
    const float finer_side = float(side_of(fine));
    const Patch s = make_patch(triangle.vertices, surface_materials[triangle.material], a, b, c, finer_side);

    const ivec3 low = max(coarse.low, part.low);
    const ivec3 high = min(coarse.high, part.high);
    if (any(greaterThan(low, high))) return;
    const int across = high.y - low.y + 1;
    const int rows = across * (high.z - low.z + 1);
    find_spans(coarse, low, high);
    for (int row = 0; row < rows;) {
        // On to a row that the triangle meets: threads that run side by side wait here for each other, and not
        // where a row costs more.
        while (row < rows && spans[row] == 0u) ++row;
        if (row == rows) break;
        const ivec3 v = ivec3(low.x + int(spans[row] & 0xFFFFu), low.y + row % across, low.z + row / across);
        const int end = low.x + int(spans[row] >> 16) - v.x;
        const RowMarks marks = row_marks(fine, v.yz, 4 * v.x);
        const uint first_voxel = scratch_voxel(part.tile, part.mip, v - part.region);
        for (int x = 0; x < end; ++x) {
            const vec3 voxel_low = vec3(plane_of(coarse, v + ivec3(x, 0, 0)) - s.corner) / finer_side;
            splat(s, voxel_low, first_voxel + uint(x), voxel_marks(marks, 4 * x));
        }
        ++row;
    }
}
