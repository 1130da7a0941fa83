// Writes the distance of the triangle at each pixel; blending keeps the least.
#include "interop/mesh.h"
#include "mesh/mesh_fragment.glsl"
#if MASKED
#include "mesh/mesh_material.glsl"
#endif

layout(location = 0) out float nearest;

void main() {
    const MeshTriangle triangle = mesh_triangles[gl_PrimitiveID];
    const MeshHit hit = hit_of(triangle, pixel_ray(ivec2(gl_FragCoord.xy)));
#if MASKED
    if (!is_shown(surface_point(triangle, hit), surface_materials[material_number()])) discard;
#endif
    nearest = hit.t;
}
