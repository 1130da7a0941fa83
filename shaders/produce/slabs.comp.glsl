// One thread is one pair, as in splat.comp.glsl: it widens the slabs of the voxels that the triangle may touch until they
// hold its part there. Voxels that it does not touch may be among them; that a slab is too wide harms nothing.
#include "interop/produce.h"
#include "interop/surface.h"
#include "produce/pairs.glsl"
#include "produce/cell_sides.glsl"
#include "pool/slab.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

// The thread's triangle. Lengths are in sides of a voxel, from the first vertex.
struct Piece {
    vec3 edge1, edge2;
    vec3 normal;       // 0 if it has no area
    float tilt_error;  // of the normal: more for a narrow triangle
    vec3 low, high;    // its bounding box
    float size;        // sum of the edges' lengths
};

Piece make_piece(ivec3 a, ivec3 b, ivec3 c, float side) {
    Piece p;
    p.edge1 = vec3(b - a) / side;
    p.edge2 = vec3(c - a) / side;
    const vec3 n = cross(p.edge1, p.edge2);
    const float area = length(n);
    p.normal = area > 0.0 ? n / area : vec3(0.0);
    const float length1 = length(p.edge1), length2 = length(p.edge2);
    p.tilt_error = 4e-7 * length1 * length2 / max(area, 1e-18);
    p.low = min(vec3(0.0), min(p.edge1, p.edge2));
    p.high = max(vec3(0.0), max(p.edge1, p.edge2));
    p.size = length1 + length2;
    return p;
}

// Bounds, along a direction on the octahedron, of the triangle's part in a voxel, from the voxel's centre. `corner`: the first vertex from
// there. The part lies in the common part of two boxes, on the triangle's plane, and between the triangle's vertices.
vec2 range_along(Piece p, vec3 direction, vec3 corner) {
    const vec3 low = clamp(corner + p.low, -0.5, 0.5);
    const vec3 high = clamp(corner + p.high, -0.5, 0.5);
    const vec3 middle = 0.5 * (low + high);
    const vec3 half_size = 0.5 * (high - low);
    const float in_box = dot(abs(direction), half_size);
    vec2 range = dot(direction, middle) + vec2(-in_box, in_box);

    const float along = dot(direction, p.normal);
    const vec3 rest = direction - along * p.normal;
    const float in_plane = dot(abs(rest), half_size) + p.tilt_error * (length(corner) + 1.0);
    const float plane = along * dot(p.normal, corner) + dot(rest, middle);
    range = vec2(max(range.x, plane - in_plane), min(range.y, plane + in_plane));

    const float first = dot(direction, corner);
    const float second = first + dot(direction, p.edge1);
    const float third = first + dot(direction, p.edge2);
    range = vec2(max(range.x, min(first, min(second, third))), min(range.y, max(first, max(second, third))));
    const float error = 2.5e-4 + 4e-7 * (length(corner) + p.size);
    return range + vec2(-error, error);
}

void main() {
    const uint i = thread_index();
    if (i >= pair_count) return;
    const PairRows part = pair_rows(i);
    const SurfaceTriangle triangle = surface_triangles[part.triangle];
    const ivec3 a = surface_position(triangle.vertices.x);
    const ivec3 b = surface_position(triangle.vertices.y);
    const ivec3 c = surface_position(triangle.vertices.z);
    const ExactTriangle t = exact_triangle(a, b, c, part.size);
    const float side = float(side_of(t));
    const Piece piece = make_piece(a, b, c, side);

    const ivec3 low = max(t.low, part.low);
    const ivec3 high = min(t.high, part.high);
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            bool in_doubt;
            ivec2 span = filtered_row_span(t, ivec2(y, z), in_doubt);
            if (!t.filtered) span = ivec2(low.x, high.x);
            span = ivec2(max(span.x, low.x), min(span.y, high.x));
            for (int x = span.x; x <= span.y; ++x) {
                const ivec3 v = ivec3(x, y, z);
                const uint sums = sums_offset + scratch_voxel(part.tile, part.mip, v - part.region) * uint(SUM_WORDS);
                const uint normals = scratch[sums + PACKED_NORMALS];
                if (!has_slab(normals)) continue;
                const vec3 direction = slab_normal(normals);
                const vec3 corner = vec3(a - plane_of(t, v)) / side - 0.5;
                const uvec2 reach = slab_reach(range_along(piece, direction, corner));
                atomicMax(scratch[sums + SLAB_REACH], reach.x);
                atomicMax(scratch[sums + SLAB_REACH + 1u], reach.y);
            }
        }
    }
}
