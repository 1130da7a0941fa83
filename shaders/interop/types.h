// Structures in buffers that C++ writes and GLSL reads. No vec3: std140 and std430 pad it, C++ does not.
#ifndef CAIRN_INTEROP_TYPES_H
#define CAIRN_INTEROP_TYPES_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace cairn::interop {
using glm::ivec4;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec4;
using uint = glm::uint;
#endif

// Vertices are numbers into the chunk's positions and attributes. A segment is (a, b, b), a point (a, a, a).
struct SurfaceTriangle {
    uvec4 vertices_material;  // xyz: vertices; w: material
};

struct SurfaceAttributes {
    uint normal;    // octahedral, snorm 16 + 16; 0 = none: use the triangle's own
    uint color;     // RGBA8, linear, 255 = 1
    vec2 texcoord;  // in the texture's space (after KHR_texture_transform)
};

struct SurfaceMaterial {
    vec4 base_color;      // linear
    uint texel_offset;    // first texel in SSBO_SURFACE_TEXELS
    uint width;           // 0 = no texture
    uint height;
    uint flags;           // MATERIAL_*
    float alpha_cutoff;
    float padding0;
    float padding1;
    float padding2;
};

#ifdef __cplusplus
static_assert(sizeof(SurfaceTriangle) == 16, "GLSL sees another layout");
static_assert(sizeof(SurfaceAttributes) == 16, "GLSL sees another layout");
static_assert(sizeof(SurfaceMaterial) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
