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

// Whether the alpha mask leaves surface at a point.
bool is_shown(SurfacePoint point, SurfaceMaterial material) {
    if ((material.flags >> MATERIAL_MASK_BIT & 1u) == 0u) return true;
    return alpha_at(point, material) * ALPHA_SLACK >= material.alpha_cutoff;
}
