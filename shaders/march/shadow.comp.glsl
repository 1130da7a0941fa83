// One thread is the waiting shadow rays of a pixel, one or more: from the surface that the primary ray met to
// the light.
#define RAYS_WIDEN SHADOW_CONES
#define VISIT_TURNS 0
// Where only the place of a mark tells whether it is the receiver's own.
#define FIRST_MARK_ENDS (WITH_MESHES == 0 && SOFT_SHADOWS == 0)
#include "interop/march.h"
#include "interop/shadow_rays.h"
#include "march/march.glsl"
#include "march/shade.glsl"
#include "pool/brick_normals.glsl"
#if SHADOW_CONES
#include "march/shadow_cone.glsl"
#endif
#include "march/self_shadow.glsl"
#define USES_SURFACE_PLANE (WITH_MESHES || SOFT_SHADOWS)
#if USES_SURFACE_PLANE
#include "march/surface_plane.glsl"
// Whether the plane of a voxel's surface decides too if a ray meets it: for rays from meshes, and to all of a
// light. A hard shadow on voxels does not depend on whether there are meshes.
bool plane_decides = SOFT_SHADOWS != 0;
#endif
#include "march/shadow_pass.glsl"

layout(binding = TEXTURE_SHADOW_ENDS) uniform samplerBuffer shadow_ends;

float receiver_width;  // of the rays that start at the receiver
// Side of the voxels that the receiver is shown with; of the finer ones, if two mips are blended.
float receiver_voxel_side;
// Side of what rays meet there: of those voxels, or of their marks.
float receiver_side() { return FINEST_LENGTH * receiver_voxel_side; }

#define SELF_SHADOW_HEIGHT 1.75  // in sides of what is met at the receiver

// Is this voxel, or mark, part of the receiver's surface?
bool is_receiver_voxel(Ray ray, vec3 centre, float t, float side) {
    float height = self_shadow_height;
    float reach = self_shadow_reach;
    float own_side = receiver_side();
#if WINDOWS
    // Side of the receiver's voxels, in units of the ray's.
    const float scale = ldexp(1.0, N_SHIFT * (seen_window - ray.window));
    height *= scale;
    reach *= scale;
    own_side *= scale;
    const vec3 from_receiver = centre - ray.origin;
#else
    const vec3 from_receiver = centre - receiver;
#endif
#if BLENDED || RAYS_WIDEN
    // Voxels that stand in for missing ones, the coarser of two mips, and what a cone sees further on, are
    // larger than the receiver's voxels.
    if (side > own_side && self_shadow_reach > 0.0) {
        height *= side / own_side;
        reach = max(reach, self_shadow_reach_of(side));
    }
#elif PROGRESSIVE
    if (stand_in && self_shadow_reach > 0.0) {  // the receiver's voxels may be larger than they should be
        height = max(height, SELF_SHADOW_HEIGHT * side);
        reach = max(reach, self_shadow_reach_of(side));
    }
#endif
    return is_receiver_voxel(from_receiver, t, height, reach);
}

#if SHADOW_CONES
// A voxel whose side is more than this many sides of the receiver's voxels is coarse: levels differ by 2 or
// more.
#define COARSE_RATIO 1.5

// Has the cone grown to voxels that are coarser than the receiver's?
bool is_coarse(Ray ray, float side) {
#if WINDOWS
    return side > COARSE_RATIO * ldexp(receiver_voxel_side, N_SHIFT * (seen_window - ray.window));
#else
    return side > COARSE_RATIO * receiver_voxel_side;
#endif
}
#endif

#if MARKS && FIRST_MARK_ENDS
bool passes_over(Ray ray, vec3 corner, float side, float t) {
    return is_receiver_voxel(ray, corner + 0.5 * side, t, side);
}
#endif
#if SEEKS_MARKS && FIRST_MARK_ENDS
void take_first_mark(inout Ray ray, Place place) { visibility = 0.0; }
#endif

// Goes on behind what casts no shadow on the receiver.
bool pass_over() {
#if MARKS
    is_counted = false;
#endif
    return true;
}

#if MARKS
// Cones that have grown see the mean surface in a voxel.
bool meets_marks(Ray ray, float voxel_side) {
#if SHADOW_CONES
    return !is_coarse(ray, voxel_side);
#else
    return true;
#endif
}
#endif

bool visit(inout Ray ray, Sample s) {
#if MARKS
    is_counted = true;
#endif
#if SHADOW_CONES
    if (is_coarse(ray, s.voxel_side)) {
        if (!is_receiver_voxel(ray, s.centre, s.t, s.side)) take_coarse(ray, s);
        return visibility * left_by_sums() > OPAQUE_TRANSMITTANCE;
    }
#endif
#if USES_SURFACE_PLANE
#if WINDOWS
    const float near = ldexp(self_shadow_reach, N_SHIFT * (seen_window - ray.window));
#else
    const float near = self_shadow_reach;
#endif
    if (plane_decides && passes_by(ray, s, near)) return pass_over();
#endif
    if (is_receiver_voxel(ray, s.centre, s.t, s.side)) return pass_over();
    visibility = behind(visibility, coverage_of(s), s.share);
    return visibility > OPAQUE_TRANSMITTANCE;
}

#if HAS_CONSTANT
bool visit_constant(Ray entered, ConstantRun run) {
#if HAS_COLOR
    const float coverage = run.mean.a;
#else
    const float coverage = run.mean.r;
#endif
    const float side = cell_length(run.voxel_shift);
    for (int voxel = 0; voxel < run.voxels && visibility > OPAQUE_TRANSMITTANCE; ++voxel) {
        const float t_in = entered.t;
        const vec3 centre = corner_of(cell_low(entered.cell, run.voxel_shift)) + 0.5 * side;
        const bool goes_on = step_over(entered, run.voxel_shift);
        if (!is_receiver_voxel(entered, centre, 0.5 * (t_in + entered.t), side)) {
            visibility = behind(visibility, coverage, 1.0);
        }
        if (!goes_on) break;
    }
    return visibility > OPAQUE_TRANSMITTANCE;
}
#endif

// Distance from the receiver past which no occluder stands before a directional light.
float end_of_occluders(vec3 to_light) {
    if (view.has_shadow_ends == 0) return ENDLESS;
    const vec2 place = vec2(dot(receiver, view.shadow_across) + view.shadow_across_offset,
                            dot(receiver, view.shadow_down) + view.shadow_down_offset);
    const ivec2 texel = clamp(ivec2(floor(place)), 0, SHADOW_ENDS_SIDE - 1);
    return texelFetch(shadow_ends, texel.y * SHADOW_ENDS_SIDE + texel.x).r - dot(receiver, to_light);
}

// The share of a sample that lies above the receiver's horizon. A cone that reaches below the horizon is
// moved: to the middle of its part above.
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
    const float widening = sqrt(float(TREE_N)) * there.width;  // so that the nearest level, by ratio, is seen
#else
    const float widening = 0.0;
#endif
    look_to_light(there.direction, receiver_side());
    Ray ray = make_ray(receiver, there.direction, there.reach, receiver_width, widening);
#if WINDOWS
    ray.window = seen_window;
#endif
    if (!march_to_light(ray, self_shadow_end(receiver_side()), starts)) return false;
#if SHADOW_CONES
    visibility *= left_by_sums();
#endif
    visibility = clear_opaque(visibility);
    return true;
}

// Sets the receiver, where shadow rays start: at this depth of the pixel's ray, on a surface with this
// normal.
void place_receiver(PixelRay seen, float depth, vec3 normal) {
    receiver = seen.origin + seen.direction * depth;
    receiver_normal = normal;
    receiver_width = width_at(seen, depth);
    receiver_voxel_side = side_shown(receiver_width);
    self_shadow_height = SELF_SHADOW_HEIGHT * receiver_side();
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
    plane_decides = plane_decides || at_mesh;
    if (at_mesh) {
        place_receiver(seen, mesh.t, mesh.plane);
        self_shadow_height = mesh_self_shadow_height * receiver_side();  // the place of a mesh is exact
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
