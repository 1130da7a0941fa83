// One thread is one primary ray through the bricks that the pool holds. It finds the depth at which the ray
// becomes opaque (Crassin 2007, section 3.6.1), and writes 1 / depth along the view in place of a colour, or
// 0 if the ray gets through.
#include "interop/march.h"
#define RAYS_WIDEN 1
#define VISIT_TURNS 0
#define FIRST_MARK_ENDS 1
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/launch.glsl"

#if MARKS
bool meets_marks(Ray ray, float voxel_side) { return true; }
bool passes_over(Ray ray, vec3 corner, float side, float t) { return false; }
#endif

bool visit(inout Ray ray, Sample s) {
    state.color.a = behind(state.color.a, coverage_of(s), s.share);
    state.depth = s.t;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

#if SEEKS_MARKS
void take_first_mark(inout Ray ray, Place place) {
    bool goes_on;
    take_voxel(ray, place, 0, 1.0, goes_on);
}
#endif

void main() {
    Launch launch;
    if (!find_pixel(launch)) return;
    const PixelRay seen = pixel_ray(launch.pixel);
    if (!march_pixel(launch, seen)) return;
    const float depth = view.skipped + state.depth * dot(seen.direction, view.forward);
    const bool is_opaque = state.color.a <= OPAQUE_TRANSMITTANCE;
    store_number(launch.index, is_opaque ? 1.0 / max(depth, 1e-6) : 0.0);
}
