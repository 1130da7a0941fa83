// From what a primary ray gathered and how much of the light reaches it, to a pixel.

// Linear to sRGB (IEC 61966-2-1).
vec3 srgb_from_linear(vec3 c) {
    const vec3 clamped = clamp(c, 0.0, 1.0);
    return mix(12.92 * clamped, 1.055 * pow(clamped, vec3(1.0 / 2.4)) - 0.055, greaterThan(clamped, vec3(0.0031308)));
}

// Where a pixel's ray starts and goes; distances along it count from `origin`, which is `skipped` from the eye.
struct PixelRay {
    vec3 origin;
    vec3 direction;  // unit
    float skipped;
};

// `pixel` in the band.
PixelRay pixel_ray(ivec2 pixel) {
    const vec2 place = (vec2(pixel + ivec2(0, view.band.x)) + 0.5) / vec2(view.size_shadow.xy) * 2.0 - 1.0;
    const vec3 across = place.x * view.right.xyz - place.y * view.up.xyz;
    const float slant = length(view.forward.xyz + across);
    PixelRay ray;
    ray.origin = view.eye.xyz + view.forward.w * across;
    ray.direction = (view.forward.xyz + across) / slant;
    ray.skipped = view.forward.w * slant;
    return ray;
}

vec3 direction_to_light(vec3 point) {
    return view.light.w > 0.5 ? normalize(view.light.xyz - point) : view.light.xyz;
}

// A gathered normal, turned to the viewer: surfaces have two sides. At a silhouette a voxel's mean looks away only
// because its surface bends away in it, and is seen edge on.
vec3 facing(vec3 gathered, vec3 direction) {
    const float size = length(gathered);
    if (size < 1e-6) return -direction;
    const vec3 normal = gathered / size;
    const float away = dot(normal, direction);
    if (away <= 0.0) return normal;
    return away < SILHOUETTE_BEND ? normalize(normal - away * direction) : -normal;
}
vec3 facing_normal(RayState state, vec3 direction) { return facing(state.normal_depth.xyz, direction); }

void write_pixel(ivec2 pixel, RayState state, float visibility) {
    const float alpha = 1.0 - state.color.a;
    vec3 color = view.background.rgb;
    if (alpha > 0.0) {
        const PixelRay seen = pixel_ray(pixel);
        const vec3 normal = facing_normal(state, seen.direction);
        const vec3 point = seen.origin + seen.direction * state.normal_depth.w;
        const float facing = max(dot(normal, direction_to_light(point)), 0.0);
        const float sky = view.light_color.w * (0.75 + 0.25 * normal.y);
        const vec3 light = view.light_color.rgb * (sky + (1.0 - view.light_color.w) * facing * visibility);
        color = state.color.rgb * light + state.color.a * view.background.rgb;
    }
    image_rgba8[pixel.y * view.size_shadow.x + pixel.x] = packUnorm4x8(vec4(srgb_from_linear(color), alpha));
}
