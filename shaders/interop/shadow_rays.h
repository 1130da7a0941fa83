// Shadow rays: samples of the light, their sums, and where nothing stands in the light any more.
#ifndef CAIRN_INTEROP_SHADOW_RAYS_H
#define CAIRN_INTEROP_SHADOW_RAYS_H

#ifdef __cplusplus
#include "shaders/interop/vectors.h"
#endif

#define SSBO_SHADOW_SUMS 6    // ShadowSum per pixel, or ShadowConeSum where the rays are cones
#define TEXTURE_SHADOW_ENDS 4

// Ends of shadow rays to a directional light: a grid across its direction (renderer/march/shadow_ends.h).
#define SHADOW_ENDS_SIDE 128

// The shape of a light: enum LightShape of optics/light.h.
#define LIGHT_SPHERE 0     // a sphere, or a directional light with an angle: even in solid angle
#define LIGHT_RECTANGLE 1  // even in area
#define LIGHT_DISK 2
#define MAX_SHADOW_RAYS 512

#ifdef __cplusplus
namespace cairn::interop {
#endif

// Shadow rays of a pixel to samples of a light, while one of them waits.
struct ShadowSum {
    uint ray;              // number of the one that waits
    float visible;         // sum over those before it
};

// Cones likewise, and what the one that waits has been covered by.
struct ShadowConeSum {
    uint ray;
    float visible;
    float front;
    float back;
};

#ifdef __cplusplus
static_assert(sizeof(ShadowSum) == 8, "GLSL sees another layout");
static_assert(sizeof(ShadowConeSum) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
