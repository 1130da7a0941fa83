// One thread is one pair: it clips the triangle to the closed voxel (Sutherland and Hodgman 1974), samples
// base colour and normal on the piece that is left, and adds them to the voxel's sums, weighted by area.
//
// The piece is computed in the triangle's barycentric weights, where each side of the voxel is a line whose
// values at the three vertices are whole numbers. So large triangles lose no accuracy, and triangles without
// area still have a piece. The piece is cut in a fan of triangles. If a texture may vary on the piece, each
// triangle of the fan is cut in `rows`^2 equal parts, about as small as a texel if ATTRIBUTE_SAMPLE_ROWS
// suffices. Each part is sampled at its centroid, by a mean around it.
#include "interop/surface.h"
#include "interop/voxelize.h"
#include "voxelize/attribute_pairs.glsl"
#include "voxelize/attribute_sums.glsl"
#include "voxelize/surface.glsl"
#define MEAN_FINENESS 2
#define MEAN_MOST_TAPS 4  // parts are small, and a thread takes many
#include "voxelize/surface_color.glsl"
#include "common/thread.glsl"

uniform ivec3 region_origin;
uniform int voxel_shift;
uniform uint count;

// A point within this distance of a side (lattice units) counts as on it, so that a triangle that only
// touches the voxel has a piece. Weights have an error of 2^-52, and distances to a side are under 2^26.
const double ON_SIDE = 1.52587890625e-5LF;  // 2^-16

#define MAX_CORNERS 9  // three, and one more for each side that cuts
// Weights of the second and third vertex; the piece lies in one half.
dvec2 corners[2 * MAX_CORNERS];

struct Piece {
    int first;  // first corner in `corners`
    int count;
};

int side_of(double value) { return int(value > ON_SIDE) - int(value < -ON_SIDE); }

// Clips a piece by a side of the voxel. `d`: distances of the three vertices from the side, positive inside.
Piece clip(Piece piece, dvec3 d) {
    Piece result = Piece(MAX_CORNERS - piece.first, 0);
    dvec2 corner = corners[piece.first + piece.count - 1];
    double value = d.x + corner.x * (d.y - d.x) + corner.y * (d.z - d.x);
    for (int i = 0; i < piece.count; ++i) {
        const dvec2 next = corners[piece.first + i];
        const double next_value = d.x + next.x * (d.y - d.x) + next.y * (d.z - d.x);
        const int side = side_of(value), next_side = side_of(next_value);
        // More than MAX_CORNERS corners could only result from rounding.
        if (side * next_side < 0 && result.count < MAX_CORNERS) {
            const dvec2 cut = corner + (value / (value - next_value)) * (next - corner);
            corners[result.first + result.count++] = cut;
        }
        if (next_side >= 0 && result.count < MAX_CORNERS) corners[result.first + result.count++] = next;
        corner = next;
        value = next_value;
    }
    return result;
}

Piece piece_in_voxel(ivec3 a, ivec3 b, ivec3 c, ivec3 voxel) {
    const ivec3 low = voxel << voxel_shift;
    const ivec3 high = low + (1 << voxel_shift);
    corners[0] = dvec2(0.0LF);
    corners[1] = dvec2(1.0LF, 0.0LF);
    corners[2] = dvec2(0.0LF, 1.0LF);
    Piece piece = Piece(0, 3);
    for (int side = 0; side < 6; ++side) {
        const int axis = side >> 1;
        const ivec3 p = ivec3(a[axis], b[axis], c[axis]);
        const ivec3 d = (side & 1) == 0 ? p - low[axis] : high[axis] - p;
        if (any(lessThan(d, ivec3(0))) && piece.count > 0) piece = clip(piece, dvec3(d));
    }
    return piece;
}

// Floats suffice for the place of a sample: on a triangle of 2^25 lattice units the error is two units.
SurfacePoint point_at(uvec3 vertices, vec2 weights) {
    return SurfacePoint(vertices, vec3(1.0 - weights.x - weights.y, weights));
}

// The number of rows of samples with which samples lie about a texel apart.
int sample_rows(Piece piece, uvec3 vertices, SurfaceMaterial material) {
    if (material.width == 0u) return 1;
    vec2 low = vec2(1.0e30), high = vec2(-1.0e30);
    for (int i = 0; i < piece.count; ++i) {
        const vec2 uv = texcoord_at(point_at(vertices, vec2(corners[piece.first + i])));
        low = min(low, uv);
        high = max(high, uv);
    }
    const vec2 texels_across = (high - low) * vec2(material.width, material.height);
    return int(clamp(ceil(max(texels_across.x, texels_across.y)), 1.0, float(ATTRIBUTE_SAMPLE_ROWS)));
}

// The centroid of part `number` of a triangle that is cut in rows^2 parts. Rows run along the side from b to
// c. Row r has r + 1 parts that point like the triangle, and between them r parts that point the other way.
vec2 centroid_of_part(vec2 a, vec2 b, vec2 c, int number, int rows) {
    int row = int(sqrt(float(number)));
    row += int((row + 1) * (row + 1) <= number) - int(row * row > number);
    const int place = number - row * row;
    const bool turned = (place & 1) != 0;
    const float along = float(row) + (turned ? 1.0 : 2.0) / 3.0;
    const float across = float(place >> 1) + (turned ? 2.0 : 1.0) / 3.0;
    return a + ((along - across) * (b - a) + across * (c - a)) / float(rows);
}

// Sums over samples.
struct Gathered {
    float weight;
    vec3 color, normal;
};

void gather(inout Gathered sum, float weight, vec3 color, vec3 normal) {
    sum.weight += weight;
    sum.color += weight * color;
    sum.normal += weight * normal;
}

#if HAS_MASK
#define NOWHERE_WEIGHT 1.0e-6

// The colour at a sample that the mask cuts away, for a piece that has no other samples: the voxel is
// occupied because the piece touches a texel nearby that passes. `weight`: 1, or NOWHERE_WEIGHT if no such
// texel is found.
vec3 color_nearby(SurfacePoint p, SurfaceMaterial material, vec3 sample_color, out float weight) {
    weight = NOWHERE_WEIGHT;
    if (material.width == 0u) return sample_color;
    const vec4 vertex_color = vertex_color_at(p);
    const vec2 uv = texcoord_at(p);
    for (int i = 0; i < 9; ++i) {
        const vec2 offset = vec2(i % 3 - 1, i / 3 - 1) / vec2(material.width, material.height);
        const vec4 texel = nearest_texel(material, uv + offset);
        if (!passes(texel.a, vertex_color.a, material)) continue;
        weight = 1.0;
        return material.base_color.rgb * vertex_color.rgb * linear_from_srgb(texel.rgb);
    }
    return sample_color;
}
#endif

// Adds one sample to `shown` or, if a mask cuts it away, to `hidden`.
void sample_point(inout Gathered shown, inout Gathered hidden, SurfacePoint p, Footprint footprint,
                  SurfaceMaterial material, vec3 triangle_normal, float weight) {
    const vec3 color = color_over(p, footprint, material);
    const vec3 normal = normal_at(p, triangle_normal);
#if HAS_MASK
    if (is_masked(material)) {
        const float alpha = material.width != 0u ? nearest_texel(material, texcoord_at(p)).a : 1.0;
        if (!passes(alpha, vertex_color_at(p).a, material)) {
            float hidden_weight;
            const vec3 nearby = color_nearby(p, material, color, hidden_weight);
            gather(hidden, hidden_weight, nearby, normal);
            return;
        }
    }
#endif
    gather(shown, weight, color, normal);
}

void main() {
    const uint thread = thread_index();
    if (thread >= count) return;
    const uvec4 pair = pairs[thread];
    const ivec3 voxel = region_origin + ivec3(pair.x & 0xFFFFu, pair.x >> 16, pair.y);
    const uvec3 triangle = surface_triangles[pair.w].vertices;
    const SurfaceMaterial material = surface_materials[surface_triangles[pair.w].material];
    const ivec3 a = surface_position(triangle.x), b = surface_position(triangle.y), c = surface_position(triangle.z);
    const Piece piece = piece_in_voxel(a, b, c, voxel);
    if (piece.count == 0) return;

    const dvec3 cross_product = cross(dvec3(b - a), dvec3(c - a));
    const double twice_area = length(cross_product);
    const vec3 triangle_normal = twice_area > 0.0LF ? vec3(cross_product / twice_area) : vec3(0.0);
    const double side = double(1 << voxel_shift);
    const int rows = sample_rows(piece, triangle, material);
    const int parts = rows * rows;
    const double faces_of_triangle = 0.5LF * twice_area / (side * side * double(parts));

    Gathered shown = Gathered(0.0, vec3(0.0), vec3(0.0));
    Gathered hidden = shown;
    const dvec2 first = corners[piece.first];
    for (int fan = 0; fan < max(piece.count - 2, 1); ++fan) {
        const dvec2 p = corners[piece.first + min(fan + 1, piece.count - 1)];
        const dvec2 q = corners[piece.first + min(fan + 2, piece.count - 1)];
        const double share = abs((p.x - first.x) * (q.y - first.y) - (p.y - first.y) * (q.x - first.x));
        const float faces = max(float(share * faces_of_triangle), 1.0e-20);
        // A parallelogram that lies in a part about its centroid, for the most.
        const float part_side = 0.5 / float(rows);
        const Footprint footprint = Footprint(part_side * vec2(p - first), part_side * vec2(q - first));
        for (int part = 0; part < parts; ++part) {
            const vec2 middle = centroid_of_part(vec2(first), vec2(p), vec2(q), part, rows);
            sample_point(shown, hidden, point_at(triangle, middle), footprint, material, triangle_normal, faces);
        }
    }
    float weight = max(shown.weight, ATTRIBUTE_LEAST_WEIGHT);
    if (shown.weight == 0.0) {
        if (hidden.weight < 0.5) weight = ATTRIBUTE_HIDDEN_WEIGHT;
        shown = hidden;
    }
    const float scale = weight / shown.weight;
    const uint place = pair.z * uint(ATTRIBUTE_SUM_WORDS);
    add_to_sum(place + SUM_WEIGHT, weight);
    add_to_sums(place + SUM_COLOR, shown.color * scale);
    add_to_sums(place + SUM_NORMAL, shown.normal * scale);
}
