// Where in a voxel its surface is, as far as the voxel tells: a plane across the mean normal, through the
// voxel's middle.
//
// A voxel is up to a diagonal thicker than the surface in it. A ray that only grazes it meets nothing half of
// the time, but finds its coverage all the same: so a receiver's own bends hid the horizon from it. The
// planes of neighbours do not join, so they are asked only near the receiver and where the surface looks its
// way, as its own bends do. Asked of all voxels, they made occluders half a voxel smaller too, and let light
// through sheets that lie across a ray.
//
// Needs self_shadow.glsl and pool/brick_normals.glsl.

// How near the plane counts as met, in sides of the voxel: with more, bends hide the horizon again.
#define SURFACE_PLANE_SLACK 0.03
// Least cosine between the receiver's normal and that of a surface that may be the receiver's.
#define SELF_SHADOW_LEAST_COSINE 0.5

// May the ray, which has just come through the voxel, pass by the surface in it? `reach`: from the receiver,
// in the ray's units.
bool passes_by(Ray ray, Sample s, float reach) {
    if (s.t >= reach) return false;
    const vec3 normal = mean_normal(texelFetch(brick_normal, s.texel + 1 + s.voxel, 0));
    if (dot(normal, receiver_normal) < SELF_SHADOW_LEAST_COSINE) return false;
    const float half_chord = ray.t - s.t;
    const float middle = dot(ray.origin - s.centre, normal) + s.t * dot(ray.direction, normal);
    const float change = half_chord * dot(ray.direction, normal);
    return abs(middle) > abs(change) + SURFACE_PLANE_SLACK * s.side * length(normal);
}
