// Shadow rays through voxels that are coarser than those at the receiver: there a ray is a cone, as wide as
// these voxels.
//
// A cone sees, of the surface in a voxel, the area across the cone's direction. That area is interpolated
// between the voxels of each layer, in the layer's middle, and summed over all layers that the ray crosses.
// The sum is how often things in the cone's way cover it on average. The front of a solid thing covers the
// same part of the cone as its back. So surfaces that face the light and surfaces that turn away from it are
// summed apart, and the larger sum counts. Sums of the coverage itself, its products and its greatest value
// were tried: they are too dark at the silhouettes of solid things, where many voxels lie behind each other,
// or let light through slanted surfaces.
float front_sum;  // of surfaces that face the receiver
float back_sum;   // of surfaces that face the light

// The share of the light that the coarser voxels let through.
float left_by_sums() { return max(1.0 - max(front_sum, back_sum), 0.0); }

// The share of the column through a voxel of the sample's mip, along the ray, that its surface covers. x: surface that
// faces the receiver; y: surface that faces the light. `along`: component of the direction across the layer.
vec2 covered_across(Sample s, ivec3 v, vec3 direction, float along) {
    const VoxelPlace place = voxel_place(s, v);
    const float coverage = coverage_at(s, place);
    const vec3 normal = mean_normal(normals_at(place));
    const float most = max(abs(normal.x), max(abs(normal.y), abs(normal.z)));
    if (most < LEAST_MEAN_NORMAL) return vec2(coverage);  // normals of opposite sides cancel out
    // Coverage is the area across the axis for which the area is greatest.
    const float facing = dot(normal, direction);
    const float share = min(coverage * abs(facing) / (most * along), 1.0);
    return facing < 0.0 ? vec2(share, 0.0) : vec2(0.0, share);
}

// Takes a voxel if the ray crosses the middle of its layer in it; the ray may cross three voxels of a layer.
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
    const ivec3 p = s.voxel + ivec3(low);
    const ivec3 u = along_x ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
    const ivec3 v = along_x || along_y ? ivec3(0, 0, 1) : ivec3(0, 1, 0);
    const float along = dot(size, axis);
    const vec2 at_low = mix(covered_across(s, p, ray.direction, along),
                            covered_across(s, p + u, ray.direction, along), dot(f, vec3(u)));
    const vec2 at_high = mix(covered_across(s, p + v, ray.direction, along),
                             covered_across(s, p + u + v, ray.direction, along), dot(f, vec3(u)));
    const vec2 covered = s.share * mix(at_low, at_high, dot(f, vec3(v)));
    front_sum += covered.x;
    back_sum += covered.y;
}
