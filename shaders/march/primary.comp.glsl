// One thread is one waiting primary ray.
#include "interop/march.h"
#define RAYS_WIDEN 1
#define VISIT_TURNS 0
#define FIRST_MARK_ENDS 1
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/visible_normal.glsl"
#if SHOW_TREE
#include "march/show_tree.glsl"
#endif

#include "march/launch.glsl"

#if MARKS
bool meets_marks(Ray ray, float voxel_side) { return true; }
#if FIRST_MARK_ENDS
bool passes_over(Ray ray, vec3 corner, float side, float t) { return false; }
#endif
#endif

bool visit(inout Ray ray, Sample s) {
#if MARKS
    is_counted = true;
#endif
#if WITH_MESHES
    if (s.t > mesh.t) return false;
#endif
    const float left = behind(state.color.a, coverage_of(s), s.share);
    const float weight = state.color.a - left;
    const Corners around = corners_around(s);
    vec3 color = view.surface_color;
#if HAS_COLOR
    const vec4 mean = filtered_color(s, around);
    color = mean.rgb / max(mean.a, LEAST_COVERAGE);
    color *= color;  // stored as square roots, whose steps look even to the eye
#endif
    const Faces faces = filtered_faces(around, ray.direction);
#if SHOW_TREE
#if WINDOWS
    first_level = windows.of[ray.window].level;
#endif
    color = tree_color(s, color, faces.all);
#endif
    state.color.rgb += weight * color;
    state.normal += weight * visible_normal(faces, ray.direction);
    const bool is_heaviest = note_heaviest(state, weight, s.t);
#if WINDOWS
    if (is_heaviest) seen_window = ray.window;
#endif
    state.color.a = left;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

#if SEEKS_MARKS
void take_first_mark(inout Ray ray, Place place) {
    bool goes_on;
    take_voxel(ray, place, 0, 1.0, goes_on);
}
#endif

#if HAS_CONSTANT
// Takes voxel by voxel, as if they stood in a brick, without normals.
bool visit_constant(Ray entered, ConstantRun run) {
#if HAS_COLOR
    vec3 color = run.mean.rgb / max(run.mean.a, LEAST_COVERAGE);
    color *= color;
    const float coverage = run.mean.a;
#else
    const vec3 color = view.surface_color;
    const float coverage = run.mean.r;
#endif
    for (int voxel = 0; voxel < run.voxels && state.color.a > OPAQUE_TRANSMITTANCE; ++voxel) {
        const float t_in = entered.t;
        const bool goes_on = step_over(entered, run.voxel_shift);
        const float left = behind(state.color.a, coverage, 1.0);
        const float weight = state.color.a - left;
        state.color.rgb += weight * color;
        note_heaviest(state, weight, 0.5 * (t_in + entered.t));
        state.color.a = left;
        if (!goes_on) break;
    }
    return state.color.a > OPAQUE_TRANSMITTANCE;
}
#endif

// Whether light can arrive at the pixel's voxels, so that a shadow ray must look for it.
bool needs_shadow_ray(PixelRay seen) {
    if (view.casts_shadows == 0 || state.color.a > 1.0 - LEAST_COVERAGE) return false;
    const vec3 point = seen.origin + seen.direction * state.depth;
    return dot(facing_normal(state, seen.direction), direction_to_light(point)) > 0.0;
}

void main() {
    Launch launch;
    if (!find_pixel(launch)) return;
    const PixelRay seen = pixel_ray(launch.pixel);
    if (!march_pixel(launch, seen)) return;

    if (state.color.a <= OPAQUE_TRANSMITTANCE) {
        // The little that still shines through is given to the surface: a solid thing shows no background.
        state.color.rgb /= 1.0 - state.color.a;
        state.color.a = 0.0;
    }
#if WINDOWS
    const PixelRay shown = pixel_ray(launch.pixel);  // in voxels of the window that the pixel shows most of
#else
    const PixelRay shown = seen;
#endif
    bool waits = needs_shadow_ray(shown);
#if WITH_MESHES
    keep_light_on_voxels(launch.index, waits ? LIGHT_NOT_KNOWN : 1.0);
    waits = waits || mesh_needs_shadow_ray(mesh, seen, state.color.a);
#endif
    if (waits) {
        leave_to_shadow_ray(launch.index);
        return;
    }
#if WITH_MESHES
    write_pixel(launch.pixel, state, 1.0, mesh, 1.0);
#else
    write_pixel(launch.pixel, state, 1.0);
#endif
}
