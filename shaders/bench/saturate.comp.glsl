// One thread is one primary ray through the bricks that are there: how deep it gets before it is opaque (Crassin 2007,
// section 3.6.1). Writes 1 / depth along the view, in place of a colour; 0 where the ray gets through.
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0 SHOW_TREE=0 TRAVERSAL=2
// defines: TREE_N=4 BRICK_M=16 MAX_LEVEL=4 HAS_COLOR=0 PROGRESSIVE=1 BLENDED=0 SHOW_TREE=0 TRAVERSAL=2
// defines: TREE_N=2 BRICK_M=8 MAX_LEVEL=7 HAS_COLOR=1 PROGRESSIVE=1 BLENDED=0 SHOW_TREE=0 TRAVERSAL=0
#define RAYS_WIDEN 1
#include "march/march.glsl"
#include "march/shade.glsl"
#include "march/launch.glsl"

bool visit(inout Ray ray, Sample s) {
    state.color.a = behind(state.color.a, coverage_of(s), s.share);
    state.normal_depth.w = s.t;
    return state.color.a > OPAQUE_TRANSMITTANCE;
}

void main() {
    Launch launch;
    if (!find_pixel(launch)) return;
    const PixelRay seen = pixel_ray(launch.pixel);
    if (!march_pixel(launch, seen)) return;
    const float depth = view.forward.w + state.normal_depth.w * dot(seen.direction, view.forward.xyz);
    const bool is_opaque = state.color.a <= OPAQUE_TRANSMITTANCE;
    image_rgba8[launch.index] = floatBitsToUint(is_opaque ? 1.0 / max(depth, 1e-6) : 0.0);
}
