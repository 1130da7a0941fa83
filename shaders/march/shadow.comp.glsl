// One thread is one waiting shadow ray: from what a primary ray saw, to the light.
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 TRAVERSAL=2
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 TRAVERSAL=1
// defines: TREE_N=2 BRICK_M=8 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=0
// defines: TREE_N=4 BRICK_M=64 MAX_LEVEL=0 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=2
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=12 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=0 WINDOWS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=6 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=0 WINDOWS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 TRAVERSAL=2 WITH_MESHES
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=2 WITH_MESHES
// defines: TREE_N=3 BRICK_M=81 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=2
// defines: TREE_N=8 BRICK_M=16 MAX_LEVEL=3 HAS_COLOR=1 PROGRESSIVE=1 TRAVERSAL=2 HAS_CONSTANT=1 HAS_FINAL=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 TRAVERSAL=2 TILE_BLOCKS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 TRAVERSAL=2 WITH_MESHES SOFT_SHADOWS
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=12 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=0 WINDOWS=1 SOFT_SHADOWS
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 BLENDED=1 TRAVERSAL=2
// defines: TREE_N=2 BRICK_M=8 BRICK_MIPS=1 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1 TRAVERSAL=1
// defines: TREE_N=8 BRICK_M=8 BRICK_MIPS=3 MAX_LEVEL=3 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1 TRAVERSAL=2 WITH_MESHES
// defines: TREE_N=4 BRICK_M=8 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0 TRAVERSAL=0
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 TRAVERSAL=2 WITH_MESHES SOFT_SHADOWS SHADOW_CONES
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=12 HAS_COLOR=0 PROGRESSIVE=1 TRAVERSAL=0 WINDOWS=1 SOFT_SHADOWS SHADOW_CONES
// defines: TREE_N=3 BRICK_M=27 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 TRAVERSAL=1 SOFT_SHADOWS SHADOW_CONES
// defines: TREE_N=8 BRICK_M=8 BRICK_MIPS=3 MAX_LEVEL=3 HAS_COLOR=0 PROGRESSIVE=1 BLENDED=1 TRAVERSAL=2 SOFT_SHADOWS SHADOW_CONES
#ifdef SHADOW_CONES
#define RAYS_WIDEN 1
#else
#define RAYS_WIDEN 0
#endif
#include "march/march.glsl"
#include "march/shade.glsl"
#include "pool/brick_normals.glsl"
#ifdef SOFT_SHADOWS
#include "march/area_light.glsl"
#ifdef SHADOW_CONES
#include "march/shadow_cone.glsl"
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { ShadowConeSum shadow_sums[]; };
#else
layout(std430, binding = SSBO_SHADOW_SUMS) buffer ShadowSumBlock { ShadowSum shadow_sums[]; };
#endif
#endif

layout(local_size_x = 64) in;

layout(binding = TEXTURE_SHADOW_ENDS) uniform samplerBuffer shadow_ends;

uniform uint ray_count;
uniform uint list_in;
uniform uint list_out;

float visibility;

float own_side;  // of the voxels that the receiver is shown with; of the finer ones, when they are blended
#include "march/own_surface.glsl"
#if defined(WITH_MESHES) || defined(SOFT_SHADOWS)
#define TELLS_SURFACE 1
#include "march/surface_plane.glsl"
#else
#define TELLS_SURFACE 0
#endif

#define OWN_HEIGHT 1.75  // in voxels

// Is this voxel the receiver's own?
bool is_own(Ray ray, vec3 centre, float t, float side) {
    float height = own_height;
    float reach = own_reach;
    float own = own_side;
#if WINDOWS
    const float scale = ldexp(1.0, N_SHIFT * (seen_window - ray.window));  // of the receiver's voxels in the ray's
    height *= scale;
    reach *= scale;
    own *= scale;
    const vec3 from_receiver = centre - ray.origin;
#else
    const vec3 from_receiver = centre - receiver;
#endif
#if BLENDED || RAYS_WIDEN
    if (side > own && own_reach > 0.0) {  // what stands in, the coarser of two mips, and what a cone sees further on
        height *= side / own;
        reach = max(reach, own_reach_of(side));
    }
#elif PROGRESSIVE
    if (stand_in && own_reach > 0.0) {  // its own voxels may be larger than they should be
        height = max(height, OWN_HEIGHT * side);
        reach = max(reach, own_reach_of(side));
    }
#endif
    return is_own(from_receiver, t, height, reach);
}

#ifdef SHADOW_CONES
// Has the cone grown to voxels that are coarser than those of the receiver?
bool is_coarse(Ray ray, float side) {
#if WINDOWS
    return side > 1.5 * ldexp(own_side, N_SHIFT * (seen_window - ray.window));
#else
    return side > 1.5 * own_side;
#endif
}
#endif

bool visit(inout Ray ray, Sample s) {
#ifdef SHADOW_CONES
    if (is_coarse(ray, s.side)) {
        if (!is_own(ray, s.centre, s.t, s.side)) take_coarse(ray, s);
        return visibility * left_by_sums() > OPAQUE_TRANSMITTANCE;
    }
#endif
#if TELLS_SURFACE
#if WINDOWS
    const float near = ldexp(own_reach, N_SHIFT * (seen_window - ray.window));
#else
    const float near = own_reach;
#endif
    if (passes_by(ray, s, near)) return true;
#endif
    if (!is_own(ray, s.centre, s.t, s.side)) visibility = behind(visibility, coverage_of(s), s.share);
    return visibility > OPAQUE_TRANSMITTANCE;
}

#if HAS_CONSTANT
bool visit_constant(Ray entered, ConstantRun run) {
#if HAS_COLOR
    const float coverage = run.mean.a;
#else
    const float coverage = run.mean.r;
#endif
    const float side = float(cell_side(run.voxel_shift));
    for (int voxel = 0; voxel < run.voxels && visibility > OPAQUE_TRANSMITTANCE; ++voxel) {
        const float t_in = entered.t;
        const vec3 centre = vec3(cell_low(entered.voxel, run.voxel_shift)) + 0.5 * side;
        const bool goes_on = step_over(entered, run.voxel_shift);
        if (!is_own(entered, centre, 0.5 * (t_in + entered.t), side)) visibility = behind(visibility, coverage, 1.0);
        if (!goes_on) break;
    }
    return visibility > OPAQUE_TRANSMITTANCE;
}
#endif

// Distance behind which nothing stands between the receiver and a directional light.
float end_of_occluders(vec3 to_light) {
    if (view.size_shadow.w == 0) return 1e30;
    const vec2 place = vec2(dot(receiver, view.shadow_across.xyz) + view.shadow_across.w,
                            dot(receiver, view.shadow_down.xyz) + view.shadow_down.w);
    const ivec2 texel = clamp(ivec2(floor(place)), 0, SHADOW_ENDS_SIDE - 1);
    return texelFetch(shadow_ends, texel.y * SHADOW_ENDS_SIDE + texel.x).r - dot(receiver, to_light);
}

// Side of the voxels that a cone of this width is shown with (see march()).
float voxel_side(float width) {
    float side = float(ROOT_SIDE / BRICK_M);
    int level = 0;
    for (; level < MAX_LEVEL && side > width; ++level) side /= float(TREE_N);
#if BLENDED
    const int own_shift = ROOT_SHIFT - M_SHIFT - N_SHIFT * level;
    side = float(cell_side(own_shift + blended_mip(own_shift, width)));
#endif
    return side;
}

// A ray from the receiver to the light, or on from where it stood. False when it must wait: then it is stored.
// @param widening  of its width, for each unit of its length
bool trace(vec3 to_light, float reach, float width, float widening, float side, bool starts, inout RayState state,
           inout int turns) {
    look_to_light(to_light, side);
    Ray ray = make_ray(receiver, to_light, reach, width, widening);
#if WINDOWS
    ray.window = seen_window;
#endif
    bool inside = true;
    if (starts) {
        visibility = 1.0;
        ray.t = own_end(side);
        inside = enter_windows(ray);
    } else {
        load_position(ray, state);
        visibility = uintBitsToFloat(state.voxel_t_weight.w);
    }
    if (inside && march(ray, turns) == MARCH_MISSING) {
        store_position(state, ray);
        state.voxel_t_weight.w = floatBitsToUint(visibility);
        return false;
    }
#ifdef SHADOW_CONES
    visibility *= left_by_sums();
#endif
    visibility = visibility > OPAQUE_TRANSMITTANCE ? visibility : 0.0;
    return true;
}

// How much of the light reaches the receiver. False when a ray must wait.
#ifdef SOFT_SHADOWS
#ifdef SHADOW_CONES
// Brings the cone above the receiver's horizon: to the middle of what is left of it there. @return the share that is left.
float rise_above_horizon(inout LightSample there) {
    const float rise = dot(receiver_normal, there.direction);
    const float risen = max(rise, 0.5 * (rise + 0.5 * there.width));
    const float share = clamp(0.5 + rise / there.width, 0.0, 1.0);
    there.direction = normalize(there.direction + (risen - rise) * receiver_normal);
    there.width = min(there.width, 2.0 * risen);
    return share;
}
#endif

bool find_light(ivec2 pixel, uint index, float width, float side, bool starts, inout RayState state) {
    const uint rays_a_pixel = uint(min(view.area_light.x, MAX_SHADOW_RAYS));
    uint first = 0u;
    float sum = 0.0;
    if (!starts) {
        first = shadow_sums[index].ray;
        sum = shadow_sums[index].visible;
    }
    int turns = 0;
    for (uint i = first; i < rays_a_pixel; ++i) {
        LightSample there = light_sample(receiver, pixel, i);
#ifdef SHADOW_CONES
        const bool resumes = !starts && i == first;
        front_sum = resumes ? shadow_sums[index].front : 0.0;
        back_sum = resumes ? shadow_sums[index].back : 0.0;
        const float share = rise_above_horizon(there);
        const float widening = sqrt(float(TREE_N)) * there.width;  // the nearest level, by ratio
#else
        const float share = dot(receiver_normal, there.direction) > 0.0 ? 1.0 : 0.0;
        const float widening = 0.0;
#endif
        if (share <= 0.0) continue;  // behind the receiver's horizon
        if (!trace(there.direction, there.reach, width, widening, side, starts || i != first, state, turns)) {
#ifdef SHADOW_CONES
            shadow_sums[index] = ShadowConeSum(i, sum, front_sum, back_sum);
#else
            shadow_sums[index] = ShadowSum(i, sum);
#endif
            return false;
        }
        sum += share * visibility;
    }
    visibility = sum / float(rays_a_pixel);
    return true;
}
#else
bool find_light(ivec2 pixel, uint index, float width, float side, bool starts, inout RayState state) {
    const vec4 light = light_there();
    const vec3 to_light = direction_to_light(receiver);
    const float reach = light.w > 0.5 ? distance(light.xyz, receiver) : end_of_occluders(to_light);
    int turns = 0;
    return trace(to_light, reach, width, 0.0, side, starts, state, turns);
}
#endif

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= ray_count) return;
    const uint index = lists[list_in + i];
    const ivec2 pixel = ivec2(int(index) % view.size_shadow.x, int(index) / view.size_shadow.x);
    RayState state = rays[index];
    const bool starts = all(equal(state.voxel_t_weight.xy, uvec2(0xFFFFFFFFu)));
#if WINDOWS
    seen_window = starts ? int(state.voxel_t_weight.z) : stored_seen_window(state);
#endif

    const PixelRay seen = pixel_ray(pixel);
    float depth = state.normal_depth.w;
    receiver_normal = facing_normal(state, seen.direction);
#ifdef WITH_MESHES
    // A pixel may have two receivers: first its voxels, then the mesh behind them.
    const MeshPixel mesh = mesh_pixel(pixel);
    const float light_on_voxels_before = uintBitsToFloat(image_rgba8[index]);
    const bool at_mesh = light_on_voxels_before >= 0.0;
    if (at_mesh) {
        depth = mesh.t;
        receiver_normal = mesh.plane;
    }
#endif
    const float width = view.background.w * view.eye.w * (seen.skipped + depth);
    const float side = voxel_side(width);
    receiver = seen.origin + seen.direction * depth;
    own_side = side;
    own_height = OWN_HEIGHT * side;
#ifdef WITH_MESHES
    if (at_mesh) own_height = mesh_own_height * side;  // its place is known exactly
#endif
    const bool found = find_light(pixel, index, width, side, starts, state);
    leave_report(index);
    if (!found) {
        rays[index] = state;
        lists[list_out + atomicAdd(counters.waiting_shadow, 1u)] = index;
        return;
    }
    const float light_found = visibility;
#ifdef WITH_MESHES
    if (!at_mesh && mesh_needs_shadow_ray(mesh, seen, state.color.a)) {
        image_rgba8[index] = floatBitsToUint(light_found);
        state.voxel_t_weight.xy = uvec2(0xFFFFFFFFu);  // not started
        rays[index] = state;
        lists[list_out + atomicAdd(counters.waiting_shadow, 1u)] = index;
        atomicAdd(counters.paused, 1u);
        return;
    }
    write_pixel(pixel, state, at_mesh ? light_on_voxels_before : light_found, mesh, at_mesh ? light_found : 1.0);
#else
    write_pixel(pixel, state, light_found);
#endif
}
