// Computes a pixel from what a primary ray through a volume gathered and the share of the light that arrives
// there. A mesh replaces the background; volumes cast no shadow on it.
#include "interop/march.h"
void write_volume_pixel(ivec2 pixel, RayState state, float visibility) {
    vec4 behind_volume = vec4(view.background, 0.0);
#if WITH_MESHES
    behind_volume = lit_mesh(mesh_pixel(pixel), pixel_ray(pixel), 1.0);
#endif
    const vec3 light = view.light_color;
    // The colour that the light adds is in place of the normal.
    const vec3 of_volume = light * (state.color.rgb + visibility * state.normal);
    const vec3 color = of_volume + state.color.a * behind_volume.rgb;
    store_color(pixel_index(pixel), color, 1.0 - state.color.a + state.color.a * behind_volume.a);
}
