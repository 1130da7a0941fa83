// One thread is one pixel of a rasterized mesh: rays from there to samples of the light, through the xy-reduced pyramid
// (Forest et al. 2009, section 3.1). What many rays leave undone goes on in the next pass, between two rays.
// defines: COLUMN_LEVELS=9 COLUMN_MASK=0
// defines: COLUMN_LEVELS=9 COLUMN_MASK=1
// defines: COLUMN_LEVELS=3 COLUMN_MASK=0 SOFT_SHADOWS
// defines: COLUMN_LEVELS=11 COLUMN_MASK=1 SOFT_SHADOWS
#include "interop/config.h"
#include "interop/bindings.h"
#include "interop/types.h"

layout(std140, binding = UBO_VIEW) uniform ViewBlock { MarchView view; };
layout(std430, binding = SSBO_IMAGE) buffer ImageBlock { uint image_rgba8[]; };
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { uvec2 shadow_sums[]; };
layout(std430, binding = SSBO_COLUMN_COUNTS) buffer CountBlock { uint paused; };

#define WITH_MESHES
#include "shadow/trace_columns.glsl"
#include "march/own_surface.glsl"
#include "march/shade.glsl"
#ifdef SOFT_SHADOWS
#include "march/area_light.glsl"
#endif

layout(local_size_x = 64) in;

uniform bool first_pass;

#define ALL_RAYS 0xFFFFFFFFu  // shadow_sums[].x: the pixel is done

bool visit_voxel(ivec3 voxel, float t) { return is_own(vec3(voxel) + 0.5 - receiver, t, own_height, own_reach); }

// Does light come that way?
bool sees_light(vec3 to_light, float reach, inout int turns) {
    look_to_light(to_light, 1.0);
    Ray ray = make_ray(receiver, to_light, reach, 0.0, 0.0);
    ray.t = own_end(1.0);
    return !trace_columns(ray, turns);
}

#ifdef SOFT_SHADOWS
// False when the pixel's rays go on in the next pass.
bool find_light(ivec2 pixel, uint index, out float share) {
    const uint rays_a_pixel = uint(min(view.area_light.x, MAX_SHADOW_RAYS));
    const uvec2 stored = first_pass ? uvec2(0u) : shadow_sums[index];
    float sum = uintBitsToFloat(stored.y);
    int turns = 0;
    for (uint i = stored.x; i < rays_a_pixel; ++i) {
        if (turns > TURN_BUDGET) {
            shadow_sums[index] = uvec2(i, floatBitsToUint(sum));
            return false;
        }
        ++turns;
        const LightSample there = light_sample(receiver, pixel, i);
        if (dot(receiver_normal, there.direction) <= 0.0) continue;  // behind the receiver's horizon
        if (sees_light(there.direction, there.reach, turns)) sum += 1.0;
    }
    share = sum / float(rays_a_pixel);
    return true;
}
#else
bool find_light(ivec2 pixel, uint index, out float share) {
    const vec4 light = light_there();
    int turns = 0;
    share = sees_light(direction_to_light(receiver), light.w > 0.5 ? distance(light.xyz, receiver) : 1e30, turns) ? 1.0 : 0.0;
    return true;
}
#endif

void main() {
    const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (index >= uint(view.size_shadow.x * view.band.y)) return;
    if (!first_pass && shadow_sums[index].x == ALL_RAYS) return;
    const ivec2 pixel = ivec2(int(index) % view.size_shadow.x, int(index) / view.size_shadow.x);
    const PixelRay seen = pixel_ray(pixel);
    const MeshPixel mesh = mesh_pixel(pixel);
    RayState state;  // no voxel is shown
    state.color = vec4(0.0, 0.0, 0.0, 1.0);
    state.normal_depth = vec4(0.0);
    state.voxel_t_weight = uvec4(0u);
    float share = 1.0;
    if (mesh_needs_shadow_ray(mesh, seen, 1.0)) {
        receiver = mesh_point(mesh, seen);
        receiver_normal = mesh.plane;
        own_height = mesh_own_height;
        if (!find_light(pixel, index, share)) {
            atomicAdd(paused, 1u);
            return;
        }
    }
    shadow_sums[index].x = ALL_RAYS;
    write_pixel(pixel, state, share, mesh, share);
}
