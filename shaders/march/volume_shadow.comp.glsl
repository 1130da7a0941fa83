// One thread is the waiting shadow rays of a pixel, one or more: from the depth in a volume that the primary
// ray noted to the light.
#define RAYS_WIDEN 0
#define VISIT_TURNS VOLUME_STEPS
#define FIRST_MARK_ENDS 0
#include "interop/march.h"
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/volume.glsl"
#include "march/volume_light.glsl"

vec3 receiver;
float width;  // width of the pixel's cone at the receiver
#include "march/shadow_pass.glsl"

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

// A volume lets light through from all sides.
float weight_of(inout LightSample there) { return 1.0; }

float end_of_occluders(vec3 to_light) { return ENDLESS; }

bool trace_one(LightSample there, bool starts) {
    const Ray ray = make_ray(receiver, there.direction, there.reach, width, 0.0);
    if (!march_to_light(ray, volume.shadow_start * side_shown(width), starts)) return false;
    visibility = clear_opaque(visibility);
    return true;
}

void main() {
    WaitingPixel waiting;
    if (!take_up(waiting)) return;
    const PixelRay seen = pixel_ray(waiting.pixel);
    width = width_at(seen, state.depth);
    receiver = seen.origin + seen.direction * state.depth;
    const bool found = find_light(waiting.pixel, waiting.index, waiting.starts);
    leave_report(waiting.index);
    if (!found) {
        leave_waiting(waiting.index);
        return;
    }
    write_volume_pixel(waiting.pixel, state, visibility);
}
