// What a shadow ray takes from voxels that are coarser than those at its receiver: then it is a cone, as wide
// as they are.
//
// Of a voxel's surface, a cone sees the area across its own direction. Summed over all voxels that the ray
// crosses, and between voxels in the middle of each layer across it, that is how often the things in the
// cone's way cover it on average. The front of a solid thing covers what its back covers too, so what faces
// the light and what turns away from it are summed apart, and the larger sum counts. Sums of the coverage
// itself were tried, its products and its greatest value: they are too dark at the silhouettes of solid
// things, where many voxels lie behind each other, or let light through slanted surfaces.
float front_sum;
float back_sum;

// The share of the light that the coarser voxels let through.
float left_by_sums() { return max(1.0 - max(front_sum, back_sum), 0.0); }

// What texel p's voxel covers of the column through it, along the ray. x: with surfaces that face the
// receiver; y: with those that face the light. `along`: the direction's component across the layer.
vec2 covered_across(ivec3 p, vec3 direction, float along) {
    const vec4 texel = texelFetch(brick_color, p, 0);
#if HAS_COLOR
    const float coverage = texel.a;
#else
    const float coverage = texel.r;
#endif
    const vec3 normal = mean_normal(texelFetch(brick_normal, p, 0));
    const float most = max(abs(normal.x), max(abs(normal.y), abs(normal.z)));
    if (most < LEAST_MEAN_NORMAL) return vec2(coverage);  // opposite sides that cancel out
    // Coverage is the area across the axis where that is greatest.
    const float facing = dot(normal, direction);
    const float share = min(coverage * abs(facing) / (most * along), 1.0);
    return facing < 0.0 ? vec2(share, 0.0) : vec2(0.0, share);
}

// Takes the voxel where the ray crosses the middle of a layer, in which it may cross three.
void take_coarse(Ray ray, Sample s) {
    const vec3 size = abs(ray.direction);
    const bool along_x = size.x >= size.y && size.x >= size.z;
    const bool along_y = !along_x && size.y >= size.z;
    const vec3 axis = vec3(along_x, along_y, !along_x && !along_y);
    const float t = dot(s.centre - ray.origin, axis) * dot(ray.inverse, axis);
    const vec3 off = (ray.origin + ray.direction * t - s.centre) * (1.0 - axis) / s.side;
    if (max(abs(off.x), max(abs(off.y), abs(off.z))) > 0.5) return;
    const vec3 low = floor(off);
    const vec3 f = off - low;
    const ivec3 p = s.texel + 1 + s.voxel + ivec3(low);
    const ivec3 u = along_x ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
    const ivec3 v = along_x || along_y ? ivec3(0, 0, 1) : ivec3(0, 1, 0);
    const float along = dot(size, axis);
    const vec2 at_low = mix(covered_across(p, ray.direction, along),
                            covered_across(p + u, ray.direction, along), dot(f, vec3(u)));
    const vec2 at_high = mix(covered_across(p + v, ray.direction, along),
                             covered_across(p + u + v, ray.direction, along), dot(f, vec3(u)));
    const vec2 covered = s.share * mix(at_low, at_high, dot(f, vec3(v)));
    front_sum += covered.x;
    back_sum += covered.y;
}
