// The start and direction of a pixel's ray. Distances along the ray count from `origin`, which lies `skipped`
// from the eye.
// Needs the define WINDOWS, and MarchView `view`.
struct PixelRay {
    vec3 origin;
    vec3 direction;  // unit
    float skipped;
};

#if WINDOWS
// The eye in voxels of the window that the pixel shows most of.
vec3 eye_there() { return windows.of[seen_window].eye; }
#else
vec3 eye_there() { return view.eye; }
#endif

// `pixel` counts from the band's first.
PixelRay pixel_ray(ivec2 pixel) {
    const vec2 size = vec2(view.width, view.height);
    const vec2 place = (vec2(pixel + ivec2(0, view.first_row)) + vec2(view.pixel_x, view.pixel_y)) / size * 2.0 - 1.0;
    const vec3 across = place.x * view.right - place.y * view.up;
    const float slant = length(view.forward + across);
    PixelRay ray;
    ray.origin = eye_there() + view.skipped * across;
    ray.direction = (view.forward + across) / slant;
    ray.skipped = view.skipped * slant;
    return ray;
}
