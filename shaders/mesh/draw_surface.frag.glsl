// Writes colour and normals of the nearest triangle at each pixel.
#include "interop/mesh.h"
#include "interop/surface.h"
#include "mesh/mesh_material.glsl"

layout(binding = TEXTURE_MESH_NEAREST) uniform sampler2D mesh_nearest;
layout(location = 0) out uvec4 surface;  // as in mesh_surface.glsl

#define NEAREST_SLACK 1e-6  // relative to the nearest distance

void main() {
    const MeshTriangle triangle = mesh_triangles[gl_PrimitiveID];
    const PixelRay seen = pixel_ray(ivec2(gl_FragCoord.xy));
    const MeshHit hit = hit_of(triangle, seen);
    const float nearest = texelFetch(mesh_nearest, ivec2(gl_FragCoord.xy), 0).r;
    // The program that found the nearest distance need not round alike.
    if (hit.t > nearest + NEAREST_SLACK * abs(nearest)) discard;
    const SurfacePoint point = surface_point(triangle, hit);
    const SurfaceMaterial material = surface_materials[material_number()];
#if MASKED
    if (!is_shown(point, material)) discard;
#endif
    const vec3 plane = dot(triangle.normal, seen.direction) > 0.0 ? -triangle.normal : triangle.normal;
    const vec3 color = color_over(point, pixel_footprint(triangle, hit, seen), material);
    surface = uvec4(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, 1.0)),
                    encode_normal(normal_at(point, triangle.normal)), encode_normal(plane));
}
