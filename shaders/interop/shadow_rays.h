// Shadow rays: samples of the light, sums of visibility, and the distances past which no occluder stands.
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
#define LIGHT_SPHERE 0     // a sphere, or a directional light with an angle: sampled evenly in solid angle
#define LIGHT_RECTANGLE 1  // sampled evenly in area
#define LIGHT_DISK 2       // sampled evenly in area
#define MAX_SHADOW_RAYS 512

#ifdef __cplusplus
namespace cairn::interop {
#endif

// The shadow rays of a pixel to samples of a light, while one of them waits.
struct ShadowSum {
    uint ray;              // number of the ray that waits
    float visible;         // sum of the visibilities of the rays before it
};

// The shadow cones of a pixel to samples of a light, while one of them waits.
struct ShadowConeSum {
    uint ray;              // number of the cone that waits
    float visible;         // sum of the visibilities of the cones before it
    // front_sum of the cone that waits (shaders/march/shadow_cone.glsl).
    float front;
    float back;            // back_sum of the cone that waits
};

#ifdef __cplusplus
static_assert(sizeof(ShadowSum) == 8, "GLSL sees another layout");
static_assert(sizeof(ShadowConeSum) == 16, "GLSL sees another layout");
}  // namespace cairn::interop
#endif

#endif
