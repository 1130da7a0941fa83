// Unit vectors in 32 bits, by the octahedral map (Cigolle et al. 2014); 0 = no vector. The twin in C++ is
// encode_normal() of voxelizer/surface/surface.cpp.
vec3 decode_normal(uint encoded) {
    const vec2 e = unpackSnorm2x16(encoded);
    const float z = 1.0 - abs(e.x) - abs(e.y);
    const vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(e, vec2(0.0)));
    return normalize(vec3(z < 0.0 ? folded : e, z));
}

// The vector (0, 0, 1) would be 0, so it is turned by the least step.
uint encode_normal(vec3 n) {
    const float sum = abs(n.x) + abs(n.y) + abs(n.z);
    if (!(sum > 0.0)) return 0u;
    const vec2 e = n.xy / sum;
    const vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(e, vec2(0.0)));
    return max(packSnorm2x16(n.z < 0.0 ? folded : e), 1u);
}
