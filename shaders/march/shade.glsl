// From what a primary ray gathered and how much of the light reaches it, to a pixel.

// Linear to sRGB (IEC 61966-2-1).
vec3 srgb_from_linear(vec3 c) {
    const vec3 clamped = clamp(c, 0.0, 1.0);
    return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, greaterThan(clamped, vec3(0.0031308)));
}

// Direction of a pixel's ray, unit.
vec3 pixel_direction(ivec2 pixel) {
    const vec2 place = (vec2(pixel) + 0.5) / vec2(view.size_shadow.xy) * 2.0 - 1.0;
    return normalize(view.forward.xyz + place.x * view.right.xyz - place.y * view.up.xyz);
}

vec3 direction_to_light(vec3 point) {
    return view.light.w > 0.5 ? normalize(view.light.xyz - point) : view.light.xyz;
}

// The gathered normal, turned to the viewer: surfaces have two sides. At a silhouette a voxel's mean looks away only
// because its surface bends away in it, and is seen edge on.
vec3 facing_normal(RayState state, vec3 direction) {
    const float size = length(state.normal_depth.xyz);
    if (size < 1e-6) return -direction;
    const vec3 normal = state.normal_depth.xyz / size;
    const float away = dot(normal, direction);
    if (away <= 0.0) return normal;
    return away < SILHOUETTE_BEND ? normalize(normal - away * direction) : -normal;
}

void write_pixel(ivec2 pixel, RayState state, float visibility) {
    const float alpha = 1.0 - state.color.a;
    vec3 color = view.background.rgb;
    if (alpha > 0.0) {
        const vec3 direction = pixel_direction(pixel);
        const vec3 normal = facing_normal(state, direction);
        const vec3 point = view.eye.xyz + direction * state.normal_depth.w;
        const float facing = max(dot(normal, direction_to_light(point)), 0.0);
        const float sky = view.light_color.w * (0.75 + 0.25 * normal.y);
        const vec3 light = view.light_color.rgb * (sky + (1.0 - view.light_color.w) * facing * visibility);
        color = state.color.rgb * light + state.color.a * view.background.rgb;
    }
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] = packUnorm4x8(vec4(srgb_from_linear(color), alpha));
}
