// One thread is one waiting shadow ray, or a pixel's share of them: from what a primary ray saw, to the
// light.
#define RAYS_WIDEN SHADOW_CONES
#define VISIT_TURNS 0
#include "interop/march.h"
#include "interop/shadow_rays.h"
#include "march/march.glsl"
#include "march/shade.glsl"
#include "pool/brick_normals.glsl"
#if SHADOW_CONES
#include "march/shadow_cone.glsl"
#endif
#include "march/own_surface.glsl"
#define TELLS_SURFACE (WITH_MESHES || SOFT_SHADOWS)
#if TELLS_SURFACE
#include "march/surface_plane.glsl"
#endif
#include "march/shadow_pass.glsl"

layout(binding = TEXTURE_SHADOW_ENDS) uniform samplerBuffer shadow_ends;

float receiver_width;  // of the rays that start there
// Of the voxels that the receiver is shown with; of the finer ones, when they are blended.
float own_side;

#define OWN_HEIGHT 1.75  // in voxels

// Is this voxel the receiver's own?
bool is_own(Ray ray, vec3 centre, float t, float side) {
    float height = own_height;
    float reach = own_reach;
    float own = own_side;
#if WINDOWS
    // Of the receiver's voxels in the ray's.
    const float scale = ldexp(1.0, N_SHIFT * (seen_window - ray.window));
    height *= scale;
    reach *= scale;
    own *= scale;
    const vec3 from_receiver = centre - ray.origin;
#else
    const vec3 from_receiver = centre - receiver;
#endif
#if BLENDED || RAYS_WIDEN
    // What stands in, the coarser of two mips, and what a cone sees further on.
    if (side > own && own_reach > 0.0) {
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

#if SHADOW_CONES
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
#if SHADOW_CONES
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
        if (!is_own(entered, centre, 0.5 * (t_in + entered.t), side)) {
            visibility = behind(visibility, coverage, 1.0);
        }
        if (!goes_on) break;
    }
    return visibility > OPAQUE_TRANSMITTANCE;
}
#endif

// Distance behind which nothing stands between the receiver and a directional light.
float end_of_occluders(vec3 to_light) {
    if (view.has_shadow_ends == 0) return 1e30;
    const vec2 place = vec2(dot(receiver, view.shadow_across) + view.shadow_across_offset,
                            dot(receiver, view.shadow_down) + view.shadow_down_offset);
    const ivec2 texel = clamp(ivec2(floor(place)), 0, SHADOW_ENDS_SIDE - 1);
    return texelFetch(shadow_ends, texel.y * SHADOW_ENDS_SIDE + texel.x).r - dot(receiver, to_light);
}

// The share of a sample that stands above the receiver's horizon. A cone is brought there as a whole: to the
// middle of what is left of it.
float weight_of(inout LightSample there) {
    const float rise = dot(receiver_normal, there.direction);
#if SHADOW_CONES
    const float risen = max(rise, 0.5 * (rise + 0.5 * there.width));
    const float share = clamp(0.5 + rise / there.width, 0.0, 1.0);
    there.direction = normalize(there.direction + (risen - rise) * receiver_normal);
    there.width = min(there.width, 2.0 * risen);
    return share;
#else
    return rise > 0.0 ? 1.0 : 0.0;
#endif
}

bool trace_one(LightSample there, bool starts) {
#if SHADOW_CONES
    const float widening = sqrt(float(TREE_N)) * there.width;  // the nearest level, by ratio
#else
    const float widening = 0.0;
#endif
    look_to_light(there.direction, own_side);
    Ray ray = make_ray(receiver, there.direction, there.reach, receiver_width, widening);
#if WINDOWS
    ray.window = seen_window;
#endif
    if (!march_to_light(ray, own_end(own_side), starts)) return false;
#if SHADOW_CONES
    visibility *= left_by_sums();
#endif
    visibility = clear_opaque(visibility);
    return true;
}

// Where the rays start: at this depth of the pixel's ray, on a surface with this normal.
void place_receiver(PixelRay seen, float depth, vec3 normal) {
    receiver = seen.origin + seen.direction * depth;
    receiver_normal = normal;
    receiver_width = width_at(seen, depth);
    own_side = side_shown(receiver_width);
    own_height = OWN_HEIGHT * own_side;
}

#if WITH_MESHES
// A pixel may have two receivers: first its voxels, then the mesh behind them.
void main() {
    WaitingPixel waiting;
    if (!take_up(waiting)) return;
    const PixelRay seen = pixel_ray(waiting.pixel);
    const MeshPixel mesh = mesh_pixel(waiting.pixel);
    const float light_on_voxels_before = kept_light_on_voxels(waiting.index);
    const bool at_mesh = light_on_voxels_before >= 0.0;
    if (at_mesh) {
        place_receiver(seen, mesh.t, mesh.plane);
        own_height = mesh_own_height * own_side;  // its place is known exactly
    } else {
        place_receiver(seen, state.depth, facing_normal(state, seen.direction));
    }
    const bool found = find_light(waiting.pixel, waiting.index, waiting.starts);
    leave_report(waiting.index);
    if (!found) {
        leave_waiting(waiting.index);
        return;
    }
    if (!at_mesh && mesh_needs_shadow_ray(mesh, seen, state.color.a)) {
        keep_light_on_voxels(waiting.index, visibility);
        store_not_started(state);
        leave_waiting(waiting.index);
        atomicAdd(counters.paused, 1u);
        return;
    }
    const float on_voxels = at_mesh ? light_on_voxels_before : visibility;
    write_pixel(waiting.pixel, state, on_voxels, mesh, at_mesh ? visibility : 1.0);
}
#else
void main() {
    WaitingPixel waiting;
    if (!take_up(waiting)) return;
    const PixelRay seen = pixel_ray(waiting.pixel);
    place_receiver(seen, state.depth, facing_normal(state, seen.direction));
    const bool found = find_light(waiting.pixel, waiting.index, waiting.starts);
    leave_report(waiting.index);
    if (!found) {
        leave_waiting(waiting.index);
        return;
    }
    write_pixel(waiting.pixel, state, visibility);
}
#endif
