// One thread is one pair: a triangle, and some slices of a tile that it may touch. It marks the finer voxels of each
// brick voxel, exactly as the voxelizer would, and adds the surface's attributes there.
// defines: BRICK_M=16 HAS_COLOR=1 HAS_MASK=1
// defines: BRICK_M=16 HAS_COLOR=1 HAS_MASK=0
// defines: BRICK_M=8 HAS_COLOR=0 HAS_MASK=0
#include "produce/scratch.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/surface.glsl"
#if HAS_MASK
#include "voxelize/alpha_mask.glsl"
#endif
#include "produce/surface_color.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = SSBO_BRICK_PAIRS) readonly buffer PairBlock { BrickPair pairs[]; };

uniform uint pair_count;

// The triangle at hand, for attributes: floats suffice here, bits are decided elsewhere.
struct Patch {
    uvec3 vertices;
    SurfaceMaterial material;
    vec3 corner, edge1, edge2;  // lattice units
    float d11, d12, d22;        // scalar products of the edges
    vec3 normal;                // the triangle's own; 0 when it has no area
};

Patch make_patch(uvec3 vertices, SurfaceMaterial material, ivec3 a, ivec3 b, ivec3 c) {
    Patch s;
    s.vertices = vertices;
    s.material = material;
    s.corner = vec3(a);
    s.edge1 = vec3(b - a);
    s.edge2 = vec3(c - a);
    s.d11 = dot(s.edge1, s.edge1);
    s.d12 = dot(s.edge1, s.edge2);
    s.d22 = dot(s.edge2, s.edge2);
    const vec3 n = cross(s.edge1, s.edge2);
    const float size = length(n);
    s.normal = size > 0.0 ? n / size : vec3(0.0);
    return s;
}

// The point of the triangle under a point of space, brought back to the triangle where it falls beside it.
SurfacePoint point_under(Patch s, vec3 lattice) {
    const vec3 d = lattice - s.corner;
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
    w /= max(w.x + w.y, 1.0);
    return SurfacePoint(s.vertices, vec3(1.0 - w.x - w.y, w));
}

// The marks of the triangle in the four finer voxels of one row inside brick voxel `v`, from bit 0.
uint row_bits(ExactTriangle fine, uint triangle, ivec3 v, ivec2 row) {
    ivec2 span = row_span(fine, row);
    span = ivec2(max(span.x, 4 * v.x), min(span.y, 4 * v.x + 3));
    if (span.x > span.y) return 0u;
    uint bits = ((2u << uint(span.y - span.x)) - 1u) << uint(span.x - 4 * v.x);
#if HAS_MASK
    for (int x = span.x; x <= span.y; ++x) {
        if (!mask_touches(triangle, ivec3(x, row), fine.shift)) bits &= ~(1u << uint(x - 4 * v.x));
    }
#endif
    return bits;
}

// Marks one brick voxel; `v` in voxels of the root cube, `word` its place in the scratch.
void splat(ExactTriangle fine, Patch s, uint triangle, ivec3 v, uint word) {
    const float fine_side = float(1 << fine.shift);
    uvec2 mask = uvec2(0u);
    float weight = 0.0;
    vec3 normal = vec3(0.0);
    vec3 color = vec3(0.0);
    const ivec2 row_low = max(4 * v.yz, fine.low.yz);
    const ivec2 row_high = min(4 * v.yz + 3, fine.high.yz);
    for (int z = row_low.y; z <= row_high.y; ++z) {
        for (int y = row_low.x; y <= row_high.x; ++y) {
            const uint bits = row_bits(fine, triangle, v, ivec2(y, z));
            if (bits == 0u) continue;
            const int place = 4 * (y & 3) + 16 * (z & 1);
            if ((z & 2) == 0) mask.x |= bits << place;
            else mask.y |= bits << place;
            const float count = float(bitCount(bits));
            const float middle = float(4 * v.x) + 0.5 * float(findLSB(bits) + findMSB(bits) + 1);
            const SurfacePoint p = point_under(s, vec3(middle, float(y) + 0.5, float(z) + 0.5) * fine_side);
            weight += count;
            normal += count * normal_at(p, s.normal);
#if HAS_COLOR
            color += count * color_at(p, s.material);
#endif
        }
    }
    if (weight == 0.0) return;
    if (mask.x != 0u) atomicOr(scratch[word + SCRATCH_MASK], mask.x);
    if (mask.y != 0u) atomicOr(scratch[word + SCRATCH_MASK + 1], mask.y);
    if (atomicAdd(scratch[word + SCRATCH_WEIGHT], uint(weight)) > SCRATCH_WEIGHT_LIMIT) return;
    // Two's complement: negative sums wrap and come out right.
    const ivec3 n = ivec3(round(normal * SCRATCH_NORMAL_UNIT));
    atomicAdd(scratch[word + SCRATCH_NORMAL], uint(n.x));
    atomicAdd(scratch[word + SCRATCH_NORMAL + 1], uint(n.y));
    atomicAdd(scratch[word + SCRATCH_NORMAL + 2], uint(n.z));
#if HAS_COLOR
    const uvec3 c = uvec3(round(clamp(color, 0.0, 64.0) * SCRATCH_COLOR_UNIT));
    atomicAdd(scratch[word + SCRATCH_COLOR], c.x);
    atomicAdd(scratch[word + SCRATCH_COLOR + 1], c.y);
    atomicAdd(scratch[word + SCRATCH_COLOR + 2], c.z);
#endif
}

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= pair_count) return;
    const uint triangle = pairs[i].triangle;
    const uint tile_index = pairs[i].tile_slices & 0xFFFFu;
    const int first_slice = int(pairs[i].tile_slices >> 16 & 0xFFu);
    const int slice_count = int(pairs[i].tile_slices >> 24);
    const BrickTile tile = tiles[tile_index];
    const int shift = tile.low_shift.w;

    const uvec4 corners = surface_triangles[triangle].vertices_material;
    const ivec3 a = surface_position(corners.x);
    const ivec3 b = surface_position(corners.y);
    const ivec3 c = surface_position(corners.z);
    const ExactTriangle coarse = exact_triangle(a, b, c, shift);
    const ExactTriangle fine = exact_triangle(a, b, c, shift - 2);
    const Patch s = make_patch(corners.xyz, surface_materials[corners.w], a, b, c);

    const ivec3 region_low = tile.low_shift.xyz - 1;
    const ivec3 low = max(coarse.low, region_low + ivec3(0, 0, first_slice));
    const ivec3 high = min(coarse.high, region_low + ivec3(SIDE - 1, SIDE - 1, first_slice + slice_count - 1));
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            const ivec2 span = row_span(coarse, ivec2(y, z));
            for (int x = max(span.x, low.x); x <= min(span.y, high.x); ++x) {
                const ivec3 v = ivec3(x, y, z);
                splat(fine, s, triangle, v, scratch_word(tile_index, v - region_low));
            }
        }
    }
}
