// One thread is one waiting primary ray.
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=0 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0 SHOW_TREE=0
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 BLENDED=1 SHOW_TREE=1
// defines: TREE_N=2 BRICK_M=8 BRICK_MIPS=1 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1 SHOW_TREE=1
// defines: TREE_N=4 BRICK_M=8 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0 SHOW_TREE=0
// defines: TREE_N=4 BRICK_M=64 BRICK_MIPS=2 MAX_LEVEL=0 HAS_COLOR=0 PROGRESSIVE=1 BLENDED=0 SHOW_TREE=0
#include "march/march.glsl"
#include "march/shade.glsl"
#if SHOW_TREE
#include "march/show_tree.glsl"
#endif

layout(local_size_x = 64) in;

uniform uint ray_count;
uniform bool first_pass;     // all pixels, in 8x8 blocks; else those of the list
uniform uint list_in;        // words in lists[]
uniform uint list_out;
uniform uint shadow_list;

RayState state;

bool visit(inout Ray ray, Sample s) {
    const float left = behind(state.color.a, coverage_of(s), s.share);
    const float weight = state.color.a - left;
    vec3 color = view.surface_color.rgb;
#if HAS_COLOR
    const vec4 mean = filtered(brick_color, s);
    color = mean.rgb / max(mean.a, 1.0 / 512.0);
    color *= color;  // stored as square roots, for the eye's sake
#endif
    const vec3 normal = filtered(brick_normal, s).xyz * 2.0 - 1.0;
#if SHOW_TREE
    color = tree_color(s, color, normal);
#endif
    state.color.rgb += weight * color;
#if BLENDED
    // Each voxel's own: the mean of two mips' normals would turn over all at once while their shares change.
    state.normal_depth.xyz += weight * facing(normal, ray.direction);
#else
    state.normal_depth.xyz += weight * normal / max(length(normal), 1e-3);
#endif
    if (weight > uintBitsToFloat(state.voxel_t_weight.w)) {
        state.voxel_t_weight.w = floatBitsToUint(weight);
        state.normal_depth.w = s.t;
    }
    state.color.a = left;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

// Is there light to be stopped on its way to this point?
bool needs_shadow_ray(PixelRay seen) {
    if (view.size_shadow.z == 0 || state.color.a > 1.0 - 1.0 / 512.0) return false;
    const vec3 point = seen.origin + seen.direction * state.normal_depth.w;
    return dot(facing_normal(state, seen.direction), direction_to_light(point)) > 0.0;
}

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= ray_count) return;
    ivec2 pixel;
    if (first_pass) {
        const int blocks = (view.size_shadow.x + 7) / 8;
        const int block = int(i / 64u);
        pixel = ivec2(block % blocks, block / blocks) * 8 + ivec2(i % 4u + 4u * (i / 32u % 2u), i / 4u % 8u);
        if (pixel.x >= view.size_shadow.x || pixel.y >= view.band.y) return;
    } else {
        const int p = int(lists[list_in + i]);
        pixel = ivec2(p % view.size_shadow.x, p / view.size_shadow.x);
    }
    const uint index = uint(pixel.y * view.size_shadow.x + pixel.x);
    const PixelRay seen = pixel_ray(pixel);
    Ray ray = make_ray(seen.origin, seen.direction, 1e30, view.eye.w * seen.skipped, view.eye.w);

    bool inside = true;
    if (first_pass) {
        state.color = vec4(0.0, 0.0, 0.0, 1.0);
        state.normal_depth = vec4(0.0);
        state.voxel_t_weight = uvec4(0u);
        inside = enter_root(ray);
    } else {
        state = rays[index];
        load_position(ray, state);
    }
    const int end = inside ? march(ray) : MARCH_DONE;

    if (end == MARCH_MISSING) {
        store_position(state, ray);
        rays[index] = state;
        lists[list_out + atomicAdd(counters.waiting_primary, 1u)] = index;
    } else {
        if (state.color.a <= OPAQUE_TRANSMITTANCE) {
            // What little shines through is the surface's own: no background in a solid thing.
            state.color.rgb /= 1.0 - state.color.a;
            state.color.a = 0.0;
        }
        if (needs_shadow_ray(seen)) {
            state.voxel_t_weight.xy = uvec2(0xFFFFFFFFu);  // not started
            rays[index] = state;
            lists[shadow_list + atomicAdd(counters.waiting_shadow, 1u)] = index;
        } else {
            write_pixel(pixel, state, 1.0);
        }
    }
}
