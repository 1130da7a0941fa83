// One thread is one waiting shadow ray, or a pixel's share of them: from where a primary ray gathered most in a volume, to
// the light.
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=2 VOLUME_STEPS=2
// defines: TREE_N=2 BRICK_M=8 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=1 VOLUME_STEPS=1 HAS_CONSTANT=1
// defines: TREE_N=4 BRICK_M=64 MAX_LEVEL=0 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=0 VOLUME_STEPS=16
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=2 VOLUME_STEPS=1 WITH_MESHES
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=2 VOLUME_STEPS=2 TILE_BLOCKS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=2 VOLUME_STEPS=2 SOFT_SHADOWS
// defines: TREE_N=2 BRICK_M=8 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=1 VOLUME_STEPS=1 HAS_CONSTANT=1 WITH_MESHES SOFT_SHADOWS
#define RAYS_WIDEN 0
#define VISIT_TURNS VOLUME_STEPS
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/volume.glsl"
#include "march/volume_light.glsl"
#ifdef SOFT_SHADOWS
#include "march/area_light.glsl"
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { ShadowSum shadow_sums[]; };
#endif

layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint list_in;
uniform uint list_out;

float visibility;

bool visit(inout Ray ray, Sample s) {
    const Neighbours around = neighbours_of(s);
    const Chord chord = chord_of(ray, s);
    float thickness = 0.0;
    float before = density_on(chord, around, 0.0);
    for (int i = 0; i < VOLUME_STEPS; ++i) {
        const float behind_it = density_on(chord, around, float(i + 1));
        thickness += step_optics(before, density_on(chord, around, float(i) + 0.5), behind_it).a;
        before = behind_it;
    }
    visibility *= exp(-thickness * chord.step * volume.voxel_size);
    return visibility > OPAQUE_TRANSMITTANCE;
}

#if HAS_CONSTANT
bool visit_constant(Ray entered, ConstantRun run) {
    const float thickness = mean_optics(run.mean.r, run.mean.r).a;
    visibility *= exp(-thickness * max(run.t_out - run.t_in, 0.0) * volume.voxel_size);
    return visibility > OPAQUE_TRANSMITTANCE;
}
#endif

// Side of the voxels that a cone of this width is shown with (descend()).
float side_shown(float width) {
    int shift = ROOT_SHIFT - M_SHIFT;
    for (int level = 0; level < MAX_LEVEL && float(cell_side(shift)) > width; ++level) shift -= N_SHIFT;
    return float(cell_side(shift));
}

vec3 receiver;
float width;  // of a pixel's cone there

// A ray from the receiver to the light, or on from where it stood. False when it must wait: then it is stored.
bool trace(vec3 to_light, float reach, bool starts, inout RayState state, inout int turns) {
    Ray ray = make_ray(receiver, to_light, reach, width, 0.0);
    bool inside = true;
    if (starts) {
        visibility = 1.0;
        ray.t = volume.shadow_start * side_shown(width);
        inside = enter_root(ray);
    } else {
        load_position(ray, state);
        visibility = uintBitsToFloat(state.voxel_t_weight.w);
    }
    if (inside && march(ray, turns) == MARCH_MISSING) {
        store_position(state, ray);
        state.voxel_t_weight.w = floatBitsToUint(visibility);
        return false;
    }
    visibility = visibility > OPAQUE_TRANSMITTANCE ? visibility : 0.0;
    return true;
}

// How much of the light reaches the receiver. False when a ray must wait.
#ifdef SOFT_SHADOWS
bool find_light(ivec2 pixel, uint index, bool starts, inout RayState state) {
    const uint rays_a_pixel = uint(min(view.area_light.x, MAX_SHADOW_RAYS));
    uint first = 0u;
    float sum = 0.0;
    if (!starts) {
        first = shadow_sums[index].ray;
        sum = shadow_sums[index].visible;
    }
    int turns = 0;
    for (uint i = first; i < rays_a_pixel; ++i) {
        const LightSample there = light_sample(receiver, pixel, i);
        if (!trace(there.direction, there.reach, starts || i != first, state, turns)) {
            shadow_sums[index] = ShadowSum(i, sum);
            return false;
        }
        sum += visibility;
    }
    visibility = sum / float(rays_a_pixel);
    return true;
}
#else
bool find_light(ivec2 pixel, uint index, bool starts, inout RayState state) {
    int turns = 0;
    const float reach = view.light.w > 0.5 ? distance(view.light.xyz, receiver) : 1e30;
    return trace(direction_to_light(receiver), reach, starts, state, turns);
}
#endif

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= ray_count) return;
    const uint index = lists[list_in + i];
    const ivec2 pixel = ivec2(int(index) % view.size_shadow.x, int(index) / view.size_shadow.x);
    RayState state = rays[index];

    const PixelRay seen = pixel_ray(pixel);
    width = view.background.w * view.eye.w * (seen.skipped + state.normal_depth.w);
    receiver = seen.origin + seen.direction * state.normal_depth.w;
    const bool starts = all(equal(state.voxel_t_weight.xy, uvec2(0xFFFFFFFFu)));
    const bool found = find_light(pixel, index, starts, state);
    leave_report(index);
    if (!found) {
        rays[index] = state;
        lists[list_out + atomicAdd(counters.waiting_shadow, 1u)] = index;
        return;
    }
    write_volume_pixel(pixel, state, visibility);
}
