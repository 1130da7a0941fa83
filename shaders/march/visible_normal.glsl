// The normal of the part of a voxel's surface that a ray sees.
//
// Those of a voxel's two normals (pool/brick_normals.glsl) count that face the viewer, weighted by the part
// of the picture that their surface covers: surfaces that face away are hidden behind. If neither normal
// faces the viewer, the voxel holds a sheet that is seen from its back; or the surface is seen edge on at a
// silhouette, and its mean normal looks away a little because the surface bends away within the voxel.
#include "interop/march.h"
#include "pool/brick_normals.glsl"

#define LEAST_SEEN 0.01  // of Faces::seen: with less, no side faces the viewer
#define LEAST_SIZE 1e-3  // of Faces::all: with less, the normals cancel out

struct Faces {
    // Sum of the normals that face the viewer, each times the part of the picture that it covers.
    vec3 seen;
    vec3 all;      // sum of all normals
    float spread;  // sum of 1 - cosine between the two normals of each texel
};

void add_faces(inout Faces faces, uint bits, float weight, vec3 direction) {
    const Normals n = unpack_normals(bits);
    const float there = has_normal(bits) ? weight : 0.0;
    const vec3 first = there * (1.0 - n.share) * n.first;
    const vec3 second = there * n.share * n.second;
    faces.seen += max(-dot(n.first, direction), 0.0) * first + max(-dot(n.second, direction), 0.0) * second;
    faces.all += first + second;
    faces.spread += there * (1.0 - dot(n.first, n.second));
}

Faces filtered_faces(Corners c, vec3 direction) {
    Faces faces = Faces(vec3(0.0), vec3(0.0), 0.0);
    add_faces(faces, normals_at(c.low), c.weights.x, direction);
    add_faces(faces, normals_at(c.next), c.weights.y, direction);
    add_faces(faces, normals_at(c.far), c.weights.z, direction);
    add_faces(faces, normals_at(c.high), c.weights.w, direction);
    return faces;
}

vec3 visible_normal(Faces faces, vec3 direction) {
    const float seen = length(faces.seen);
    if (seen > LEAST_SEEN) return faces.seen / seen;
    const float size = length(faces.all);
    if (size < LEAST_SIZE) return -direction;
    const vec3 normal = faces.all / size;
    const float away = dot(normal, direction);
#if BLENDED
    // Two mips must not turn to opposite sides while their shares change.
    const float bend = SILHOUETTE_BEND;
#else
    // The distance between the two unit normals; the outermost normals are about as far from the mean.
    const float bend = clamp(sqrt(max(2.0 * faces.spread / size, 0.0)), VOXEL_SILHOUETTE_BEND, SILHOUETTE_BEND);
#endif
    return away > bend ? -normal : normalize(normal - max(away, 0.0) * direction);
}
