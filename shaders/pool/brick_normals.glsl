// The normals of a voxel in 32 bits: two unit normals of its surface, by the octahedral map (Cigolle et al.
// 2014), and the share of the second one, at most a half. Dense bricks keep them in texels of 10 + 10 + 10 + 2
// bits.
//     bits 0 to 17   first normal: 9 + 9 bits, values from 1 on; 0: no normal
//     bits 18 to 29  second normal: 6 + 6 bits; or, if there is one normal alone, a slab (pool/slab.glsl)
//     bits 30 to 31  share of the second normal, in sixths; 0: there is one normal alone
struct Normals {
    vec3 first;
    vec3 second;
    float share;
};

vec2 octahedral_place(vec3 n) {
    const vec2 e = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(e, vec2(0.0)));
    return n.z < 0.0 ? folded : e;
}

// On the octahedron: the sum of the components' sizes is 1.
vec3 on_octahedron(vec2 e) {
    const float z = 1.0 - abs(e.x) - abs(e.y);
    return vec3(e - max(-z, 0.0) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(e, vec2(0.0))), z);
}

vec3 from_octahedral_place(vec2 e) { return normalize(on_octahedron(e)); }

#define WHOLE_SLAB (63u << 24)  // from the first to the last step

uint pack_normals(Normals n) {
    const uvec2 first = uvec2(round(octahedral_place(n.first) * 255.0 + 256.0));
    const uvec2 second = uvec2(round(octahedral_place(n.second) * 31.0 + 31.0));
    const uint share = uint(round(6.0 * n.share));
    return first.x | first.y << 9 | (share == 0u ? WHOLE_SLAB : second.x << 18 | second.y << 24 | share << 30);
}

uint pack_normal(vec3 n) { return pack_normals(Normals(n, n, 0.0)); }

// As a texel of a dense brick, and back.
vec4 normal_texel(uint bits) {
    return vec4(vec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20 & 1023u) / 1023.0, float(bits >> 30) / 3.0);
}
uint normal_bits(vec4 texel) {
    const uvec4 t = uvec4(texel * vec4(1023.0, 1023.0, 1023.0, 3.0) + 0.5);
    return t.x | t.y << 10 | t.z << 20 | t.w << 30;
}

bool has_normal(uint bits) { return (bits & 0x3FFFFu) != 0u; }

vec2 first_octahedral_place(uint bits) { return (vec2(bits & 511u, bits >> 9 & 511u) - 256.0) / 255.0; }

Normals unpack_normals(uint bits) {
    Normals n;
    n.first = from_octahedral_place(first_octahedral_place(bits));
    n.second = from_octahedral_place((vec2(bits >> 18 & 63u, bits >> 24 & 63u) - 31.0) / 31.0);
    n.share = float(bits >> 30) / 6.0;
    if (bits >> 30 == 0u) n.second = n.first;
    return n;
}

// Mean normal of the voxel's whole surface: short if its sides face different ways, 0 if there is none.
vec3 mean_normal(uint bits) {
    const Normals n = unpack_normals(bits);
    return has_normal(bits) ? mix(n.first, n.second, n.share) : vec3(0.0);
}
// A mean normal shorter than this is the rounding error of the normals of opposite sides, which cancel out.
#define LEAST_MEAN_NORMAL 0.125
