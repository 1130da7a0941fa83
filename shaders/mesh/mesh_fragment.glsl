// The point where the ray through a pixel's centre meets the triangle that is drawn there. The rasterizer
// decides which pixels a triangle covers. The point is computed from the ray and the triangle's plane, and
// nothing is interpolated.
#include "interop/march.h"
#include "interop/mesh.h"

layout(std140, binding = UBO_VIEW) uniform ViewBlock { MarchView view; };
layout(std430, binding = SSBO_MESH_TRIANGLES) restrict readonly buffer MeshTriangleBlock {
    MeshTriangle mesh_triangles[];
};

#define WINDOWS 0
#include "march/pixel_ray.glsl"

struct MeshHit {
    float t;        // distance from the ray's origin
    vec3 from_eye;  // the point, relative to MarchView.eye
};

// The hit is clamped to the depths of the vertices, which rounding may miss for a triangle that is seen edge
// on.
MeshHit hit_of(MeshTriangle triangle, PixelRay seen) {
    const vec3 origin = seen.origin - view.eye;
    precise const float along = dot(triangle.normal, seen.direction);
    precise const float height = triangle.height - dot(triangle.normal, origin);
    precise const float slant = 1.0 / dot(seen.direction, view.forward);
    precise const float t = abs(along) > 1e-30 ? height / along : triangle.nearest * slant;
    precise const float clamped = clamp(t, triangle.nearest * slant, triangle.furthest * slant);
    return MeshHit(clamped, origin + seen.direction * clamped);
}
