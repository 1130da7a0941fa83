// The shadow rays of a pixel: one to the middle of the light or, with SOFT_SHADOWS, several to samples of the
// light. A ray that must wait, and the rays after it, go on in the next pass; shadow_sums[] carries their
// sums from pass to pass.
//
// The includer supplies `receiver`, where the rays start, and four functions:
//     bool pauses_before_ray()
//         whether the thread has done enough in this pass
//     bool trace_one(LightSample there, bool starts)
//         traces one ray, from its start or from where it stood; sets `visibility` to the share of the light that
//         arrives by it. False if the ray must wait.
//     float weight_of(inout LightSample there)
//         the share of a sample that can light the receiver at all, by how the surface is turned; it may move
//         the sample. 0: no ray is sent.
//     float end_of_occluders(vec3 to_light)
//         the distance past which no occluder stands before a directional light
// Needs the defines SOFT_SHADOWS and SHADOW_CONES, and shade.glsl.
#include "interop/shadow_rays.h"

struct LightSample {
    vec3 direction;  // unit direction from the receiver
    float reach;     // distance from the receiver
    // Width at distance 1 of the part of the light that the sample stands for.
    float width;
};

bool pauses_before_ray();
bool trace_one(LightSample there, bool starts);
float weight_of(inout LightSample there);
float end_of_occluders(vec3 to_light);

#if SHADOW_CONES
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { ShadowConeSum shadow_sums[]; };
#else
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { ShadowSum shadow_sums[]; };
#endif

// The share of the light that is left to the ray that is traced; after find_light(), the mean over all rays.
float visibility;
int shadow_turns = 0;  // loop turns that the thread has taken in this pass

#if SOFT_SHADOWS
#include "march/area_light.glsl"

#if SHADOW_CONES
void store_sum(uint index, uint ray, float visible) {
    shadow_sums[index] = ShadowConeSum(ray, visible, front_sum, back_sum);
}
#else
void store_sum(uint index, uint ray, float visible) { shadow_sums[index] = ShadowSum(ray, visible); }
#endif

// Sets `visibility` to the share of the light that reaches the receiver. False if a ray must wait.
bool find_light(ivec2 pixel, uint index, bool starts) {
    const uint sample_count = uint(min(view.shadow_rays, MAX_SHADOW_RAYS));
    uint first = 0u;
    float sum = 0.0;
    if (!starts) {
        first = shadow_sums[index].ray;
        sum = shadow_sums[index].visible;
    }
    for (uint i = first; i < sample_count; ++i) {
        if (pauses_before_ray()) {
            store_sum(index, i, sum);
            return false;
        }
        LightSample there = light_sample(receiver, pixel, i);
        const bool resumes = !starts && i == first;
#if SHADOW_CONES
        front_sum = resumes ? shadow_sums[index].front : 0.0;
        back_sum = resumes ? shadow_sums[index].back : 0.0;
#endif
        const float weight = weight_of(there);
        if (weight <= 0.0) continue;
        if (!trace_one(there, !resumes)) {
            store_sum(index, i, sum);
            return false;
        }
        sum += weight * visibility;
    }
    visibility = sum / float(sample_count);
    return true;
}
#else
bool find_light(ivec2 pixel, uint index, bool starts) {
    const LightPlace light = light_there();
    const vec3 to_light = direction_to_light(receiver);
    const float reach = light.is_positional ? distance(light.at, receiver) : end_of_occluders(to_light);
    return trace_one(LightSample(to_light, reach, 0.0), starts);
}
#endif
