// Where in a voxel its surface is, as far as the voxel tells: a plane across the mean normal, through the voxel's middle.
//
// A voxel is up to a diagonal thicker than the surface in it. A ray that only grazes it meets nothing half of the time, but
// finds its coverage all the same; so occluders were half a voxel too large, and a receiver's own bends hid the horizon
// from it. The plane errs to both sides alike.
#include "pool/brick_normals.glsl"

// How near the plane counts as met, in sides of the voxel. The planes of neighbours do not join to a closed surface: without
// it, light leaks between them; with more, occluders grow again.
#define SURFACE_PLANE_SLACK 0.03

// Does the ray, which has just come through the voxel, meet its surface? Where opposite sides cancel out there is no normal,
// and the voxel is met as a whole.
bool meets_surface(Ray ray, Sample s) {
    const vec3 normal = mean_normal(texelFetch(brick_normal, s.texel + 1 + s.voxel, 0));
    const float size = length(normal);
    if (size < LEAST_MEAN_NORMAL) return true;
    const float half_chord = ray.t - s.t;
    const float middle = dot(ray.origin - s.centre, normal) + s.t * dot(ray.direction, normal);
    const float change = half_chord * dot(ray.direction, normal);
    return abs(middle) <= abs(change) + SURFACE_PLANE_SLACK * s.side * size;
}
