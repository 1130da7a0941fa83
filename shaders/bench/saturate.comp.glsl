// One thread is one primary ray through the bricks that the pool holds. It finds the depth at which the ray
// becomes opaque (Crassin 2007, section 3.6.1), and writes 1 / depth along the view in place of a colour, or
// 0 if the ray gets through.
#include "interop/march.h"
#define RAYS_WIDEN 1
#define VISIT_TURNS 0
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/launch.glsl"

bool visit(inout Ray ray, Sample s) {
    state.color.a = behind(state.color.a, coverage_of(s), s.share);
    state.depth = s.t;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

void main() {
    Launch launch;
    if (!find_pixel(launch)) return;
    const PixelRay seen = pixel_ray(launch.pixel);
    if (!march_pixel(launch, seen)) return;
    const float depth = view.skipped + state.depth * dot(seen.direction, view.forward);
    const bool is_opaque = state.color.a <= OPAQUE_TRANSMITTANCE;
    store_number(launch.index, is_opaque ? 1.0 / max(depth, 1e-6) : 0.0);
}
