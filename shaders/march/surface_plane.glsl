// An estimate of the surface in a voxel, or in a mark: a plane across the mean normal, through the middle of the voxel,
// or of the mark that is met. In a slab it is where the ray meets it; there a plane that passes near the receiver is
// taken for the receiver's own.
//
// A voxel is up to a diagonal thicker than the surface in it. A ray that only grazes the voxel misses the
// surface half of the time, but without this file meets the voxel's coverage every time: then the bends of a
// receiver hide the horizon from the receiver itself. The planes of neighbouring voxels do not join, so
// planes are used only near the receiver, for surfaces that face as the receiver does. Used for all voxels,
// they made occluders half a voxel smaller too, and let light through sheets that lie across a ray.
//
// Needs self_shadow.glsl and pool/brick_normals.glsl.

// Distance within which the plane counts as met, in sides of the voxel. With more, bends hide the horizon
// again.
#define SURFACE_PLANE_SLACK 0.03
// Distance of a slab's plane from the receiver, in sides of what is met, under which the surface is the receiver's.
#define OWN_PLANE_DISTANCE 1.0
// Least cosine between the receiver's normal and that of a surface that may be the receiver's.
#define SELF_SHADOW_LEAST_COSINE 0.5

// Whether the ray, which has just crossed the voxel, passes by the surface in it. `reach`: greatest distance
// from the receiver of such a voxel, in the ray's units.
bool passes_by(Ray ray, Sample s, float reach) {
    if (s.t >= reach) return false;
    const vec3 normal = mean_normal(normals_at(voxel_place(s, s.voxel)));
    if (dot(normal, receiver_normal) < SELF_SHADOW_LEAST_COSINE) return false;
#if MARKS
    if (s.is_in_slab) return abs(dot(ray.direction * s.t, normal)) < OWN_PLANE_DISTANCE * s.side * length(normal);
#endif
    const float half_chord = ray.t - s.t;
    const float middle = dot(ray.origin - s.centre, normal) + s.t * dot(ray.direction, normal);
    const float change = half_chord * dot(ray.direction, normal);
    return abs(middle) > abs(change) + SURFACE_PLANE_SLACK * s.side * length(normal);
}
