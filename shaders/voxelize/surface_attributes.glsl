// What a surface carries beside its shape (voxelizer/surface/surface.h): an attribute block a vertex, and all
// texels.
#include "interop/surface.h"

layout(std430, binding = SSBO_SURFACE_ATTRIBUTES) restrict readonly buffer AttributeBlock {
    SurfaceAttributes attributes[];
};
layout(std430, binding = SSBO_SURFACE_TEXELS) restrict readonly buffer TexelBlock { uint texels[]; };
