// What a ray takes from the voxels of a brick. What is left of `transmittance` behind a voxel. Voxels of one
// surface cover different parts of a pixel, so their shares add up instead of multiplying; and from half
// covered on, no light may leak between them. Between two mips (march.glsl), `share` is the voxel's weight.
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

// The texels around a sample's middle that a filtered fetch mixes. Of the eight whose centres are the corners
// of a cube, the four of the tetrahedron along its diagonal that holds the middle: as smooth as a trilinear
// fetch, for half the fetches (tetrahedral interpolation: Kasson et al. 1995). The one of the voxel itself is
// among them.
struct Corners {
    ivec3 low;
    ivec3 next;
    ivec3 far;
    vec4 weights;  // of low, next, far, low + 1
};

// The weight of the voxel itself, the only one that is surely occupied, must not vanish: so much is added to
// it. The sum of the weights need not be 1.
#define VOXEL_EXTRA_WEIGHT 0.125

// By hand, because the samplers' own filtering rounds by where in the pool the slot lies, and by driver; the
// brick's border keeps it inside the slot.
Corners corners_around(Sample s) {
    const vec3 place = s.middle + 0.5;  // from the border's first texel centre
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
