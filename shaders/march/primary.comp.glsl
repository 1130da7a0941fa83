// One thread is one waiting primary ray.
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=2
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 SHOW_TREE=1 TRAVERSAL=1
// defines: TREE_N=2 BRICK_M=8 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 SHOW_TREE=1 TRAVERSAL=0
// defines: TREE_N=4 BRICK_M=64 MAX_LEVEL=0 HAS_COLOR=0 PROGRESSIVE=1 SHOW_TREE=0 TRAVERSAL=2
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=12 HAS_COLOR=0 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=0 WINDOWS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=6 HAS_COLOR=0 PROGRESSIVE=1 SHOW_TREE=1 TRAVERSAL=0 WINDOWS=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=2 WITH_MESHES WITH_PROXY
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=1 SHOW_TREE=0 TRAVERSAL=2 WITH_MESHES
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=0 SHOW_TREE=1 TRAVERSAL=2 WITH_PROXY
// defines: TREE_N=3 BRICK_M=27 MAX_LEVEL=5 HAS_COLOR=1 PROGRESSIVE=1 SHOW_TREE=1 TRAVERSAL=2
// defines: TREE_N=8 BRICK_M=16 MAX_LEVEL=3 HAS_COLOR=0 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=1 HAS_CONSTANT=1 HAS_FINAL=1
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=8 HAS_COLOR=1 PROGRESSIVE=1 SHOW_TREE=0 TRAVERSAL=2 HAS_CONSTANT=1
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=2 TILE_BLOCKS=1
// defines: TREE_N=2 BRICK_M=16 MAX_LEVEL=12 HAS_COLOR=0 PROGRESSIVE=0 SHOW_TREE=0 TRAVERSAL=0 WINDOWS=1 TILE_BLOCKS=1
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 BLENDED=1 SHOW_TREE=1 TRAVERSAL=2
// defines: TREE_N=2 BRICK_M=8 BRICK_MIPS=1 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1 SHOW_TREE=1 TRAVERSAL=1
// defines: TREE_N=8 BRICK_M=8 BRICK_MIPS=3 MAX_LEVEL=3 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1 SHOW_TREE=0 TRAVERSAL=2 WITH_MESHES
// defines: TREE_N=4 BRICK_M=8 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0 SHOW_TREE=0 TRAVERSAL=0
#define RAYS_WIDEN 1
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/visible_normal.glsl"
#if SHOW_TREE
#include "march/show_tree.glsl"
#endif

#include "march/launch.glsl"


bool visit(inout Ray ray, Sample s) {
#ifdef WITH_MESHES
    if (s.t > mesh.t) return false;
#endif
    const float left = behind(state.color.a, coverage_of(s), s.share);
    const float weight = state.color.a - left;
    const Corners around = corners_around(s);
    vec3 color = view.surface_color.rgb;
#if HAS_COLOR
    const vec4 mean = filtered(brick_color, around);
    color = mean.rgb / max(mean.a, 1.0 / 512.0);
    color *= color;  // stored as square roots, for the eye's sake
#endif
    const Faces faces = filtered_faces(around, ray.direction);
#if SHOW_TREE
#if WINDOWS
    first_level = windows.of[ray.window].shift_level.w;
#endif
    color = tree_color(s, color, faces.all);
#endif
    state.color.rgb += weight * color;
    state.normal_depth.xyz += weight * visible_normal(faces, ray.direction);
    if (weight > uintBitsToFloat(state.voxel_t_weight.w)) {
        state.voxel_t_weight.w = floatBitsToUint(weight);
        state.normal_depth.w = s.t;
#if WINDOWS
        seen_window = ray.window;
#endif
    }
    state.color.a = left;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

#if HAS_CONSTANT
// Voxel by voxel, as if they stood in a brick, without a normal.
bool visit_constant(Ray entered, ConstantRun run) {
#if HAS_COLOR
    vec3 color = run.mean.rgb / max(run.mean.a, 1.0 / 512.0);
    color *= color;
    const float coverage = run.mean.a;
#else
    const vec3 color = view.surface_color.rgb;
    const float coverage = run.mean.r;
#endif
    for (int voxel = 0; voxel < run.voxels && state.color.a > OPAQUE_TRANSMITTANCE; ++voxel) {
        const float t_in = entered.t;
        const bool goes_on = step_over(entered, run.voxel_shift);
        const float left = behind(state.color.a, coverage, 1.0);
        const float weight = state.color.a - left;
        state.color.rgb += weight * color;
        if (weight > uintBitsToFloat(state.voxel_t_weight.w)) {
            state.voxel_t_weight.w = floatBitsToUint(weight);
            state.normal_depth.w = 0.5 * (t_in + entered.t);
        }
        state.color.a = left;
        if (!goes_on) break;
    }
    return state.color.a > OPAQUE_TRANSMITTANCE;
}
#endif

// Is there light to be stopped on its way to this point?
bool needs_shadow_ray(PixelRay seen) {
    if (view.size_shadow.z == 0 || state.color.a > 1.0 - 1.0 / 512.0) return false;
    const vec3 point = seen.origin + seen.direction * state.normal_depth.w;
    return dot(facing_normal(state, seen.direction), direction_to_light(point)) > 0.0;
}

void main() {
    Launch launch;
    if (!find_pixel(launch)) return;
    const PixelRay seen = pixel_ray(launch.pixel);
    if (!march_pixel(launch, seen)) return;

    if (state.color.a <= OPAQUE_TRANSMITTANCE) {
        // What little shines through is the surface's own: no background in a solid thing.
        state.color.rgb /= 1.0 - state.color.a;
        state.color.a = 0.0;
    }
#if WINDOWS
    const PixelRay shown = pixel_ray(launch.pixel);  // in the window of what it shows
#else
    const PixelRay shown = seen;
#endif
    bool waits = needs_shadow_ray(shown);
#ifdef WITH_MESHES
    // Until the pixel is written, its place keeps the light that reaches the voxels; negative: not known yet.
    image_rgba8[launch.index] = floatBitsToUint(waits ? -1.0 : 1.0);
    waits = waits || mesh_needs_shadow_ray(mesh, seen, state.color.a);
#endif
    if (waits) {
        leave_to_shadow_ray(launch.index);
        return;
    }
#ifdef WITH_MESHES
    write_pixel(launch.pixel, state, 1.0, mesh, 1.0);
#else
    write_pixel(launch.pixel, state, 1.0);
#endif
}
