// The soft shadow map (Atty et al. 2005). Its passes use these bindings alone, and none of the ray-marcher's.
#ifndef CAIRN_INTEROP_SHADOW_MAP_H
#define CAIRN_INTEROP_SHADOW_MAP_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define ATTRIBUTE_SHADOW_POSITION 0
#define ATTRIBUTE_SHADOW_NORMAL 1
#define ATTRIBUTE_SHADOW_COLOR 2
#define ATTRIBUTE_SHADOW_TEXCOORD 3
#define ATTRIBUTE_SHADOW_PATCH 0     // MicroPatch, one per instance
#define TEXTURE_SHADOW_BASE_COLOR 0  // base colour of the material that is drawn
#define TEXTURE_SHADOW_OCCLUDERS 0   // inverse depths of the closest occluders, or of the furthest
#define TEXTURE_SHADOW_RECEIVERS 1   // inverse depths of receivers; 0 = no receiver
// Pyramid of the least inverse depth of receivers; SHADOW_NONE = no receiver.
#define TEXTURE_SHADOW_PYRAMID 2
#define TEXTURE_SHADOW_HIDDEN 3      // sums of the shares of the light that micro-patches hide
#define TEXTURE_SHADOW_HIDDEN_FURTHEST 4
#define TEXTURE_SHADOW_VISIBLE 5     // the soft shadow map
#define IMAGE_SHADOW_LEVEL 0         // the level or map that a compute pass writes
#define SSBO_SHADOW_COUNTS 0         // SHADOW_COUNT_*, then micro-patches per row of the occluder map
#define SSBO_SHADOW_PATCHES 1        // MicroPatch

// An inverse depth in textures that no surface has: none is so close to the light.
#define SHADOW_NONE 1e30
#define SHADOW_LIST_GROUP 32
#define SHADOW_COUNT_PATCHES 0
#define SHADOW_COUNT_FRAGMENTS 1  // texels of all penumbra extents: low word, then high word
#define SHADOW_COUNT_ROWS 3
// Texels that a penumbra extent reaches past where rounding may have put its edges.
#define SHADOW_EXTENT_SLACK 0.0625

#ifdef __cplusplus
namespace cairn::interop {
#endif

// A texel of the occluder map as a small rectangle parallel to the light (Atty et al. 2005, section 3.2), and
// the texels of the soft shadow map that it may darken. Words of two 16-bit halves: x | y << 16.
struct MicroPatch {
    uint texel;            // texel of the occluder map
    float inverse_depth;   // 1 / distance from the light's plane
    uint extent_low;       // first texel of the penumbra extent
    // Past the last texel of the extent; equal to the first: no texel is darkened.
    uint extent_high;
};

#ifdef __cplusplus
static_assert(sizeof(MicroPatch) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
