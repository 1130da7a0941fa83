// One pass of shadow rays that march: a thread takes up a pixel that waits, sends the pixel's rays on, and
// leaves the pixel to the next pass if a ray must wait again.
#include "interop/march.h"
#include "common/thread.glsl"
#include "march/shadow_rays.glsl"

uniform uint ray_count;
// First words in lists[] of the list that is read, and of the one that is written.
uniform uint list_in;
uniform uint list_out;

RayState state;  // state of the thread's pixel

struct WaitingPixel {
    uint index;    // number of the pixel's state
    ivec2 pixel;   // place in the band
    bool starts;   // no shadow ray has been sent yet
};

// Takes up the thread's pixel; false if there is none.
bool take_up(out WaitingPixel waiting) {
    const uint i = thread_index();
    waiting = WaitingPixel(0u, ivec2(0), true);
    if (i >= ray_count) return false;
    const uint index = lists[list_in + i];
    state = rays[index];
    waiting = WaitingPixel(index, pixel_at(index), !has_started(state));
#if WINDOWS
    seen_window = stored_seen_window(state);
#endif
    return true;
}

void leave_waiting(uint index) {
    rays[index] = state;
    lists[list_out + atomicAdd(counters.waiting_shadow, 1u)] = index;
}

// Never, because march() counts the turns, and pauses within a ray.
bool pauses_before_ray() { return false; }

// Moves a ray to the light: from distance `t_start` if it starts, else from where it stood. False if the ray
// must wait; then it is stored.
bool march_to_light(Ray ray, float t_start, bool starts) {
    bool inside = true;
    if (starts) {
        visibility = 1.0;
        ray.t = t_start;
        inside = enter_windows(ray);
    } else {
        load_position(ray, state);
        visibility = state.weight;
    }
    if (inside && march(ray, shadow_turns) == MARCH_MISSING) {
        store_position(state, ray);
        state.weight = visibility;
        return false;
    }
    return true;
}

// The light that is left, or 0 if it is so little that a ray would have stopped.
float clear_opaque(float left) { return left > OPAQUE_TRANSMITTANCE ? left : 0.0; }

// Side of the voxels that a cone of this width sees (descend()); of the finer ones, if two mips are blended.
float side_shown(float width) {
    int shift = ROOT_SHIFT - M_SHIFT;
    for (int level = 0; level < MAX_LEVEL && cell_length(shift) > width; ++level) shift -= N_SHIFT;
#if BLENDED
    shift += blended_mip(shift, width);
#endif
    return cell_length(shift);
}

// Width of the shadow rays that start at a depth of a pixel's ray.
float width_at(PixelRay seen, float depth) {
    return view.shadow_cone_scale * view.pixel_cone * (seen.skipped + depth);
}
