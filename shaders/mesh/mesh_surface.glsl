// The rasterized mesh at a pixel. Texels hold x, y: base colour (linear, half floats); z: normal; w: normal
// of the triangle's plane, turned to the viewer.
#include "interop/mesh.h"
#include "voxelize/octahedral.glsl"

layout(binding = TEXTURE_MESH_NEAREST) uniform sampler2D mesh_nearest;
layout(binding = TEXTURE_MESH_SURFACE) uniform usampler2D mesh_surface;
uniform int mesh_first_row;     // row of the picture that is row 0 of these textures
uniform bool voxels_hidden;     // voxels are not shown, but cast shadows
uniform bool mesh_shadows;      // voxels cast shadows on meshes
// In sides of a voxel: voxels whose centres lie lower over the mesh are part of its surface
// (self_shadow.glsl).
uniform float mesh_self_shadow_height;

struct MeshPixel {
    float t;      // distance from the ray's origin; MESH_MISS = no mesh
    vec3 color;   // linear base colour
    vec3 normal;  // interpolated normal; 0 = no mesh
    // Normal of the triangle's plane, turned to the viewer; 0 = no mesh.
    vec3 plane;
};

// `pixel` counts from the band's first.
MeshPixel mesh_pixel(ivec2 pixel) {
    const ivec2 place = pixel + ivec2(0, view.first_row - mesh_first_row);
    const uvec4 surface = texelFetch(mesh_surface, place, 0);
    MeshPixel mesh = MeshPixel(texelFetch(mesh_nearest, place, 0).r, vec3(0.0), vec3(0.0), vec3(0.0));
    if (surface.w != 0u) {
        mesh.color = vec3(unpackHalf2x16(surface.x), unpackHalf2x16(surface.y).x);
        mesh.normal = decode_normal(surface.z);
        mesh.plane = decode_normal(surface.w);
    }
    return mesh;
}

bool is_there(MeshPixel mesh) { return mesh.t < MESH_MISS; }
