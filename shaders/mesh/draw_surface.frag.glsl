// Colour and normals of the nearest triangle at each pixel.
// defines: MASKED=0
// defines: MASKED=1
#include "mesh/mesh_material.glsl"

layout(binding = TEXTURE_MESH_NEAREST) uniform sampler2D mesh_nearest;
layout(location = 0) out uvec4 surface;  // see mesh_surface.glsl

void main() {
    const MeshTriangle triangle = mesh_triangles[gl_PrimitiveID];
    const PixelRay seen = pixel_ray(ivec2(gl_FragCoord.xy));
    const MeshHit hit = hit_of(triangle, seen);
    const float nearest = texelFetch(mesh_nearest, ivec2(gl_FragCoord.xy), 0).r;
    // Two programs need not round alike.
    if (hit.t > nearest + 1e-6 * abs(nearest)) discard;
    const SurfacePoint point = surface_point(triangle, hit);
    const SurfaceMaterial material = surface_materials[material_number()];
#if MASKED
    if (!is_shown(point, material)) discard;
#endif
    const vec3 plane = dot(triangle.plane.xyz, seen.direction) > 0.0 ? -triangle.plane.xyz : triangle.plane.xyz;
    const vec3 color = color_at(point, material);
    surface = uvec4(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, 1.0)),
                    encode_normal(normal_at(point, triangle.plane.xyz)), encode_normal(plane));
}
