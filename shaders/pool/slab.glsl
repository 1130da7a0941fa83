// The slab of a voxel: two planes across its normal, between which all of the surface in the voxel lies (contours:
// Laine and Karras 2010, section 3.2). A ray that meets a triangle meets the slab there, so no ray passes a closed
// surface.
//
// Voxels of one normal have one, in the bits of the second normal (brick_normals.glsl): the first and the last of 64
// equal steps from one corner of the voxel, along the normal, to the opposite one; 6 bits each.
#include "pool/brick_normals.glsl"

// Points p, in sides of the voxel from its centre, between dot(normal, p) = low and dot(normal, p) = high. The normal is
// the one on the octahedron, so that the furthest corner of a cube of side s lies s / 2 along it.
struct Slab {
    vec3 normal;
    float low, high;
};

bool has_slab(uint bits) { return has_normal(bits) && bits >> 30 == 0u; }

vec3 slab_normal(uint bits) { return on_octahedron(first_octahedral_place(bits)); }

Slab unpack_slab(uint bits) {
    return Slab(slab_normal(bits), float(bits >> 18 & 63u) / 64.0 - 0.5, float((bits >> 24 & 63u) + 1u) / 64.0 - 0.5);
}

// What is gathered: how far the surface reaches along the normal and against it, each from the corner that is
// furthest behind, plus one; 0 if there is nothing.
#define SLAB_REACH_BITS 23
#define SLAB_STEP_BITS (SLAB_REACH_BITS - 6)

// `range`: of dot(normal, p) on the surface.
uvec2 slab_reach(vec2 range) {
    const vec2 reach = clamp(0.5 + vec2(-range.x, range.y), 0.0, 1.0);
    return uvec2(ceil(reach * float(1 << SLAB_REACH_BITS))) + 1u;
}

// Gives the normal its slab.
uint with_slab(uint bits, uvec2 reach) {
    if (!has_slab(bits) || reach.x == 0u || reach.y == 0u) return bits;
    const uint first = min((uint(1 << SLAB_REACH_BITS) + 1u - reach.x) >> SLAB_STEP_BITS, 63u);
    const uint end = (reach.y - 1u + uint((1 << SLAB_STEP_BITS) - 1)) >> SLAB_STEP_BITS;
    return bits & ~(4095u << 18) | first << 18 | max(end, first + 1u) - 1u << 24;
}

// So far along its normal, in sides of the voxel, may a slab reach into a mark without being thought to meet it.
#define SLAB_MARK_SLACK 0.05

// Do the marks tell no more than the slab: does the slab meet, by more than a little, marks alone that are set?
bool is_slab_enough(Slab slab, uvec2 marks) {
    const float height = 0.125 - SLAB_MARK_SLACK;
    const vec2 bounds = vec2(slab.low - height, slab.high + height);
    const vec4 x = slab.normal.x * (vec4(0.0, 1.0, 2.0, 3.0) - 1.5) * 0.25;
    uvec2 passed_by = uvec2(0u);
    for (int row = 0; row < 8; ++row) {  // of one half of the voxel, and of the other
        const vec2 yz = vec2(row & 3, row >> 2) - 1.5;
        const vec4 near = x + dot(slab.normal.yz, yz) * 0.25;
        const vec4 far = near + slab.normal.z * 0.5;
        const uvec4 met_near = uvec4(greaterThan(near, vec4(bounds.x))) & uvec4(lessThan(near, vec4(bounds.y)));
        const uvec4 met_far = uvec4(greaterThan(far, vec4(bounds.x))) & uvec4(lessThan(far, vec4(bounds.y)));
        const uvec4 place = uvec4(1u, 2u, 4u, 8u);
        const uvec4 near_bits = met_near * place, far_bits = met_far * place;
        passed_by |= uvec2(near_bits.x | near_bits.y | near_bits.z | near_bits.w,
                           far_bits.x | far_bits.y | far_bits.z | far_bits.w) << uint(4 * row);
    }
    return ((passed_by.x & ~marks.x) | (passed_by.y & ~marks.y)) == 0u;
}

// The coverage (coverage.glsl) of what lies between the planes: the share of the 4^2 columns, along the axis that the
// normal is nearest to, which meet the slab.
float coverage_of_slab(Slab slab) {
    const vec3 n = abs(slab.normal);
    const vec3 turned = n.x >= n.y && n.x >= n.z ? slab.normal.yzx : n.y >= n.z ? slab.normal.zxy : slab.normal;
    const float height = 0.5 * abs(turned.z) + 0.125 * (abs(turned.x) + abs(turned.y));
    int columns = 0;
    for (int i = 0; i < 16; ++i) {
        const float middle = dot(turned.xy, (vec2(i & 3, i >> 2) - 1.5) * 0.25);
        if (middle + height > slab.low && middle - height < slab.high) ++columns;
    }
    return float(columns) / 16.0;
}
