// The surface: triangles, their attributes and materials, as voxelize/, produce/ and mesh/ read them.
#ifndef CAIRN_INTEROP_SURFACE_H
#define CAIRN_INTEROP_SURFACE_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define SSBO_SURFACE_POSITIONS 0   // int[3] per vertex, lattice units
#define SSBO_SURFACE_TRIANGLES 1   // SurfaceTriangle
#define SSBO_SURFACE_ATTRIBUTES 2  // SurfaceAttributes per vertex
#define SSBO_SURFACE_MATERIALS 3   // SurfaceMaterial
// A buffer texture of one uint per texel: RGBA8 texels of all images, mip levels, and counts of masks.
#define TEXTURE_SURFACE_TEXELS 6
#define ATTRIBUTE_POSITION 0       // position of a vertex, when the surface is rasterized

// Texture coordinates are rounded to 1 / TEXCOORD_UNITS when a surface is built, and to 1 / TEXEL_UNITS of a
// texel when an alpha mask is read (shaders/voxelize/alpha_mask.glsl, voxelizer/surface/exact_mask.h).
#define TEXCOORD_UNITS 67108864.0
#define TEXCOORD_LIMIT 1048576.0
#define TEXEL_UNITS 256
#define TEXEL_COORDINATE_LIMIT 33554432.0

// Bits of SurfaceMaterial.flags
#define MATERIAL_WRAP_S_SHIFT 0  // 2 bits: 0 repeat, 1 mirrored repeat, 2 clamp to edge
#define MATERIAL_WRAP_T_SHIFT 2
#define MATERIAL_MASK_BIT 16     // alpha-masked: texels under the cutoff are holes

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A triangle. A segment is a triangle (a, b, b), a point (a, a, a).
struct SurfaceTriangle {
    uvec3 vertices;  // numbers into the chunk's positions and attributes
    uint material;
};

struct SurfaceAttributes {
    // Octahedral, snorm 16 + 16; 0 = none: the triangle's normal is used.
    uint normal;
    uint red_green, blue_alpha;  // linear, unorm 16 + 16, the first in the low bits
    float u, v;                  // texture coordinate, after KHR_texture_transform
};

struct SurfaceMaterial {
    vec4 base_color;      // linear
    uint texel_offset;    // first texel in TEXTURE_SURFACE_TEXELS
    uint width;           // 0 = no texture
    uint height;
    uint flags;           // MATERIAL_*
    float alpha_cutoff;
    // A texel passes the mask if texel alpha * vertex alpha * 256 >= alpha_threshold * 257, with texel alphas
    // of 0 to 255 and vertex alphas of 0 to 65535 (257 * 255).
    uint alpha_threshold;
    // If masked and textured: place in TEXTURE_SURFACE_TEXELS of (width + 1) * (height + 1) counts. Count (x, y)
    // is the number of texels left of x and above y that pass, for vertex alpha 65535.
    uint passing_offset;
    // Place in TEXTURE_SURFACE_TEXELS of the texture's mip level 1, behind which the others lie
    // (voxelizer/surface/texture_mips.h); 0: there are none. Those of a masked material leave out the texels
    // that do not pass for vertex alpha 65535, and their alpha is the share of those that pass.
    uint mip_offset;
};

#ifdef __cplusplus
static_assert(sizeof(SurfaceTriangle) == 16, "GLSL sees another layout");
static_assert(sizeof(SurfaceAttributes) == 20, "GLSL sees another layout");
static_assert(sizeof(SurfaceMaterial) == 48, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
