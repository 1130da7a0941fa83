// One thread is one waiting primary ray through a volume.
#include "interop/march.h"
#define RAYS_WIDEN 1
#define VISIT_TURNS VOLUME_STEPS
#define FIRST_MARK_ENDS 0
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/volume.glsl"
#include "march/volume_light.glsl"
#if SHOW_TREE
#include "march/show_tree.glsl"
#endif

#include "march/launch.glsl"

// For a volume, `state` gathers in color.rgb the colour without the light, and in normal the colour that the
// light adds.

// A pixel to which the light adds less than this in every channel sends no shadow ray.
#define LEAST_DIRECT_LIGHT (1.0 / 1024.0)

// Light at a place in the volume: from everywhere, and from the light.
struct Lit {
    float sky;
    float direct;
};

// The steeper the density is at the place, the more the place is lit as a two-sided surface, and the less as
// fog.
Lit light_at(Ray ray, float t, vec3 gradient) {
    const float steep = length(gradient);
    const float surface = volume.full_gradient > 0.0 ? min(steep / volume.full_gradient, 1.0) : 0.0;
    const vec3 normal = (dot(gradient, ray.direction) < 0.0 ? gradient : -gradient) / max(steep, 1e-6);
    const float facing = max(dot(normal, direction_to_light(ray.origin + ray.direction * t)), 0.0);
    const float ambient = view.ambient;
    return Lit(ambient * mix(1.0, sky_share(normal), surface), (1.0 - ambient) * mix(1.0, facing, surface));
}

// Takes a stretch of the ray that absorbs and emits evenly. @return the weight of the stretch in the pixel.
float gather(vec4 optics, float world_length, Lit lit) {
    const float weight = state.color.a * (1.0 - exp(-optics.a * world_length));
    const vec3 color = optics.rgb / max(optics.a, 1e-30);
    state.color.rgb += weight * lit.sky * color;
    state.normal += weight * lit.direct * color;
    state.color.a -= weight;
    return weight;
}

// Notes the depth at which the pixel's shadow ray will start: where half of the light of the pixel has
// passed, which moves evenly through voxels, so that a surface is not shadowed in steps. If more than half
// passes the whole volume, it is the depth of the voxel that weighs most.
#define HALF_PASSED 2.0  // weighs more than any voxel
void note_depth(float t_in, float t_out, float weight) {
    const float after = state.color.a;
    const float before = after + weight;
    if (before > 0.5 && after <= 0.5) {
        const float share = log(2.0 * before) / max(log(before / max(after, 1e-9)), 1e-6);
        state.depth = mix(t_in, t_out, clamp(share, 0.0, 1.0));
        state.weight = HALF_PASSED;
    } else {
        note_heaviest(state, weight, 0.5 * (t_in + t_out));
    }
}

bool visit(inout Ray ray, Sample s) {
    const Neighbours around = neighbours_of(s);
    const Chord chord = chord_of(ray, s);
    const vec3 gradient = gradient_at(around, clamp(chord.middle, -0.5, 0.5));
    const Lit lit = light_at(ray, s.t, gradient);
    float weight = 0.0;
    float before = density_on(chord, around, 0.0);
    for (int i = 0; i < VOLUME_STEPS; ++i) {
        const float behind_it = density_on(chord, around, float(i + 1));
        vec4 optics = step_optics(before, density_on(chord, around, float(i) + 0.5), behind_it);
#if SHOW_TREE
        optics.rgb = optics.a * tree_color(s, optics.rgb / max(optics.a, 1e-30), gradient);
#endif
        weight += gather(optics, chord.step * volume.voxel_size, lit);
        before = behind_it;
    }
    note_depth(2.0 * s.t - ray.t, ray.t, weight);
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

#if HAS_CONSTANT
bool visit_constant(Ray entered, ConstantRun run) {
    const Lit lit = light_at(entered, 0.5 * (run.t_in + run.t_out), vec3(0.0));
    const vec4 optics = mean_optics(run.mean.r, run.mean.r);
    const float weight = gather(optics, max(run.t_out - run.t_in, 0.0) * volume.voxel_size, lit);
    note_depth(run.t_in, run.t_out, weight);
    return state.color.a > OPAQUE_TRANSMITTANCE;
}
#endif

void main() {
    Launch launch;
    if (!find_pixel(launch) || !march_pixel(launch, pixel_ray(launch.pixel))) return;
    if (state.color.a <= OPAQUE_TRANSMITTANCE) {
        // The little that still shines through is given to the volume: an opaque thing shows no background.
        state.color.rgb /= 1.0 - state.color.a;
        state.normal /= 1.0 - state.color.a;
        state.color.a = 0.0;
    }
    const vec3 direct = state.normal;
    if (view.casts_shadows != 0 && max(direct.x, max(direct.y, direct.z)) > LEAST_DIRECT_LIGHT) {
        leave_to_shadow_ray(launch.index);
    } else {
        write_volume_pixel(launch.pixel, state, 1.0);
    }
}
