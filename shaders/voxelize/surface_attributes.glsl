// The attributes of one chunk of the surface, one block per vertex, and all texels
// (voxelizer/surface/surface.h).
#include "interop/surface.h"

layout(std430, binding = SSBO_SURFACE_ATTRIBUTES) restrict readonly buffer AttributeBlock {
    SurfaceAttributes attributes[];
};
layout(std430, binding = SSBO_SURFACE_TEXELS) restrict readonly buffer TexelBlock { uint texels[]; };
