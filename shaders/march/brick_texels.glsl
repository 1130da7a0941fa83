// What a ray takes from the voxels of a brick.
// What is left of `transmittance` behind a voxel. Voxels of one surface cover different parts of a pixel, so their
// shares add up instead of multiplying; and from half covered on, no light may leak between them. Between two mips
// (march.glsl), `share` is the voxel's weight.
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

// Trilinear fetch at a sample's middle. By hand, because the samplers' own filtering rounds by where in the pool the slot
// lies, and by driver; the brick's border keeps it inside the slot.
vec4 filtered(sampler3D texels, Sample s) {
    const vec3 place = s.middle + 0.5;  // from the border's first texel centre
    const vec3 low = floor(place);
    const vec3 f = place - low;
    const ivec3 p = s.texel + ivec3(low);
    const vec4 y0 = mix(mix(texelFetch(texels, p, 0), texelFetch(texels, p + ivec3(1, 0, 0), 0), f.x),
                        mix(texelFetch(texels, p + ivec3(0, 1, 0), 0), texelFetch(texels, p + ivec3(1, 1, 0), 0), f.x),
                        f.y);
    const vec4 y1 = mix(mix(texelFetch(texels, p + ivec3(0, 0, 1), 0), texelFetch(texels, p + ivec3(1, 0, 1), 0), f.x),
                        mix(texelFetch(texels, p + ivec3(0, 1, 1), 0), texelFetch(texels, p + ivec3(1, 1, 1), 0), f.x),
                        f.y);
    return mix(y0, y1, f.z);
}
