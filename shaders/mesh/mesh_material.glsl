// Colour and alpha mask of the surface at a hit, by the code that colours voxels.
#include "interop/mesh.h"
#include "interop/surface.h"
#include "mesh/mesh_fragment.glsl"
#include "voxelize/surface.glsl"
#include "voxelize/surface_color.glsl"

uniform uint first;  // number in the chunk of the batch's first triangle

uint material_number() { return surface_triangles[first + uint(gl_PrimitiveID)].material; }

SurfacePoint surface_point(MeshTriangle triangle, MeshHit hit) {
    const vec3 from_corner = hit.from_eye - triangle.corner;
    const float b = dot(from_corner, triangle.second), c = dot(from_corner, triangle.third);
    const vec3 weights = max(vec3(1.0 - b - c, b, c), 0.0);
    return SurfacePoint(surface_triangles[first + uint(gl_PrimitiveID)].vertices,
                        weights / (weights.x + weights.y + weights.z));
}

// The part of the triangle's plane that a pixel sees: the sides of a parallelogram, as changes of the weights
// from the pixel to the one beside it and to the one below it. A plane that is seen edge on fills pixels
// without end; then a side is no longer than the triangle.
Footprint pixel_footprint(MeshTriangle triangle, MeshHit hit, PixelRay seen) {
    const vec2 size = vec2(view.width, view.height);
    const vec3 steps[2] = vec3[2](2.0 / size.x * view.right, -2.0 / size.y * view.up);
    const float along = dot(triangle.normal, seen.direction);
    const float slant = dot(seen.direction, view.forward);
    vec2 sides[2];
    for (int i = 0; i < 2; ++i) {
        // Where the ray of the next pixel meets the plane, to first order.
        const vec3 moved = steps[i] * ((hit.t + seen.skipped) * slant);
        const float back = abs(along) > 1e-6 ? dot(triangle.normal, moved) / along : 0.0;
        const vec3 on_plane = moved - back * seen.direction;
        const vec2 side = vec2(dot(on_plane, triangle.second), dot(on_plane, triangle.third));
        sides[i] = side / max(max(abs(side.x), abs(side.y)), 1.0);
    }
    return Footprint(sides[0], sides[1]);
}

// Whether the alpha mask leaves surface at a point.
bool is_shown(SurfacePoint point, SurfaceMaterial material) {
    if (!is_masked(material)) return true;
    return alpha_at(point, material) * ALPHA_SLACK >= material.alpha_cutoff;
}
