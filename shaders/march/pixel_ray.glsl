// Where a pixel's ray starts and goes; distances along it count from `origin`, which is `skipped` from the
// eye.
// Needs the define WINDOWS, and MarchView `view`.
struct PixelRay {
    vec3 origin;
    vec3 direction;  // unit
    float skipped;
};

#if WINDOWS
// In voxels of the window of what the pixel shows.
vec3 eye_there() { return windows.of[seen_window].eye; }
#else
vec3 eye_there() { return view.eye; }
#endif

// `pixel` in the band.
PixelRay pixel_ray(ivec2 pixel) {
    const vec2 size = vec2(view.width, view.height);
    const vec2 place = (vec2(pixel + ivec2(0, view.first_row)) + 0.5) / size * 2.0 - 1.0;
    const vec3 across = place.x * view.right - place.y * view.up;
    const float slant = length(view.forward + across);
    PixelRay ray;
    ray.origin = eye_there() + view.skipped * across;
    ray.direction = (view.forward + across) / slant;
    ray.skipped = view.skipped * slant;
    return ray;
}
