// Where a pixel's ray starts and goes; distances along it count from `origin`, which is `skipped` from the eye.
struct PixelRay {
    vec3 origin;
    vec3 direction;  // unit
    float skipped;
};

#ifndef WINDOWS
#define WINDOWS 0
#endif
#if WINDOWS
// In voxels of the window of what the pixel shows.
vec3 eye_there() { return windows.of[seen_window].eye.xyz; }
#else
vec3 eye_there() { return view.eye.xyz; }
#endif

// `pixel` in the band.
PixelRay pixel_ray(ivec2 pixel) {
    const vec2 place = (vec2(pixel + ivec2(0, view.band.x)) + 0.5) / vec2(view.size_shadow.xy) * 2.0 - 1.0;
    const vec3 across = place.x * view.right.xyz - place.y * view.up.xyz;
    const float slant = length(view.forward.xyz + across);
    PixelRay ray;
    ray.origin = eye_there() + view.forward.w * across;
    ray.direction = (view.forward.xyz + across) / slant;
    ray.skipped = view.forward.w * slant;
    return ray;
}
