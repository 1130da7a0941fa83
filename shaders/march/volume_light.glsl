// From what a primary ray through a volume gathered, and how much of the light reaches it, to a pixel.
void write_volume_pixel(ivec2 pixel, RayState state, float visibility) {
    const vec3 light = view.light_color.rgb;
    const vec3 color = light * (state.color.rgb + visibility * state.normal_depth.xyz) +
                       state.color.a * view.background.rgb;
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] =
        packUnorm4x8(vec4(srgb_from_linear(color), 1.0 - state.color.a));
}
