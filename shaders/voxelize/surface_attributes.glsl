// The attributes of one chunk of the surface, one block per vertex, and all texels
// (voxelizer/surface/surface.h).
#include "interop/surface.h"

layout(std430, binding = SSBO_SURFACE_ATTRIBUTES) restrict readonly buffer AttributeBlock {
    SurfaceAttributes attributes[];
};
layout(binding = TEXTURE_SURFACE_TEXELS) uniform usamplerBuffer surface_texels;

uint surface_texel(uint place) { return texelFetch(surface_texels, int(place)).x; }

vec4 attribute_color(uint vertex) {
    return vec4(unpackUnorm2x16(attributes[vertex].red_green), unpackUnorm2x16(attributes[vertex].blue_alpha));
}

// 0 to 65535.
int attribute_alpha(uint vertex) { return int(attributes[vertex].blue_alpha >> 16); }

vec2 attribute_texcoord(uint vertex) { return vec2(attributes[vertex].u, attributes[vertex].v); }
