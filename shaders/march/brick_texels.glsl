// Coverage and filtered texels of the voxels of a brick, for rays.

// The transmittance behind a voxel. Voxels of one surface cover different parts of a pixel, so their shares
// add up instead of multiplying; and a voxel that is at least half covered is opaque, so that no light leaks
// between neighbours. If two mips are blended (blend.glsl), `share` is the voxel's weight.
float behind(float transmittance, float coverage, float share) {
    return max(transmittance - share * min(2.0 * coverage, 1.0), 0.0);
}

float coverage_of(Sample s) {
    const vec4 texel = texelFetch(brick_color, s.texel + 1 + s.voxel, 0);
#if HAS_COLOR
    return texel.a;
#else
    return texel.r;
#endif
}

// The texels around a sample's middle that a filtered fetch mixes. The centres of eight texels are the
// corners of a cube around the middle. Four of them are used: those of the tetrahedron along the cube's
// diagonal that holds the middle. That is as smooth as a trilinear fetch, for half the fetches (tetrahedral
// interpolation: Kasson et al. 1995). The texel of the voxel itself is among them.
struct Corners {
    ivec3 low;
    ivec3 next;
    ivec3 far;
    vec4 weights;  // weights of the texels low, next, far and low + 1
};

// The weight of the voxel itself, the only one that is surely occupied, must not vanish: so much is added to
// it. The sum of the weights need not be 1.
#define VOXEL_EXTRA_WEIGHT 0.125

// Texels are filtered by hand, because the rounding of the samplers' filter depends on the slot's place in
// the pool and on the driver. The brick's border keeps all texels inside the slot.
Corners corners_around(Sample s) {
    const vec3 place = s.middle + 0.5;  // relative to the centre of the border's first texel
    const vec3 f = fract(place);
    const float most = max(f.x, max(f.y, f.z));
    const float least = min(f.x, min(f.y, f.z));
    const float other = max(min(f.x, f.y), min(max(f.x, f.y), f.z));
    const ivec3 up = f.x == most ? ivec3(1, 0, 0) : f.y == most ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    const ivec3 left_out = f.z == least ? ivec3(0, 0, 1) : f.y == least ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
    Corners c;
    c.low = s.texel + ivec3(floor(place));
    c.next = c.low + up;
    c.far = c.low + 1 - left_out;
    c.weights = vec4(1.0 - most, most - other, other - least, least);
    const ivec3 corner = s.texel + 1 + s.voxel - c.low;
    c.weights += VOXEL_EXTRA_WEIGHT * vec4(equal(ivec4(corner.x + corner.y + corner.z), ivec4(0, 1, 2, 3)));
    return c;
}

vec4 filtered(sampler3D texels, Corners c) {
    return c.weights.x * texelFetch(texels, c.low, 0) + c.weights.y * texelFetch(texels, c.next, 0) +
           c.weights.z * texelFetch(texels, c.far, 0) + c.weights.w * texelFetch(texels, c.low + 1, 0);
}
