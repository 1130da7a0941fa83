// The ends of a pixel's shadow rays: samples of a light that has an extent.
//
// The samples are Hammersley points, which are stratified in each coordinate and together. An offset per
// pixel turns them modulo 1 (Cranley and Patterson 1976): neighbouring pixels take different samples, and a
// pixel takes the same ones in every frame.
#include "interop/shadow_rays.h"

#define PI 3.14159265
#define QUARTER_PI 0.78539816339
#define HASH_ROW_PIXELS 16384u  // no picture is wider, so pixels have different hashes

// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering": pcg.
uint hashed(uint x) {
    const uint state = x * 747796405u + 2891336453u;
    const uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// The top 24 bits as a number in [0, 1).
float unit_of(uint x) { return float(x >> 8u) * (1.0 / 16777216.0); }

// Sample i of a pixel, in the unit square. `pixel` counts from the band's first.
vec2 sample_place(ivec2 pixel, uint i) {
    const uint x_turn = hashed(uint(pixel.x) + HASH_ROW_PIXELS * uint(pixel.y + view.first_row));
    const uint y_turn = hashed(x_turn ^ 0x9E3779B9u);
    const float x = (float(i) + 0.5) / float(view.shadow_rays);
    return fract(vec2(x, unit_of(bitfieldReverse(i))) + vec2(unit_of(x_turn), unit_of(y_turn)));
}

// Maps the unit square to the unit disk; strata stay compact (Shirley and Chiu 1997).
vec2 on_disk(vec2 place) {
    const vec2 p = 2.0 * place - 1.0;
    const bool wide = abs(p.x) > abs(p.y);
    const float radius = wide ? p.x : p.y;
    const float part = (wide ? p.y : p.x) / (radius == 0.0 ? 1.0 : radius);
    const float angle = wide ? QUARTER_PI * part : 2.0 * QUARTER_PI - QUARTER_PI * part;
    return radius * vec2(cos(angle), sin(angle));
}

// Factor from the unit of the view's lengths to voxels of the window that the receiver is in.
float light_scale() {
#if WINDOWS
    return ldexp(1.0, N_SHIFT * (windows.count.x - 1 - seen_window));
#else
    return 1.0;
#endif
}

LightSample flat_sample(vec3 centre, vec3 point, vec2 p) {
    const vec3 way = centre + light_scale() * (p.x * view.light_half_u + p.y * view.light_half_v) - point;
    const float reach = length(way);
    const vec3 direction = way / reach;
    const float square = view.light_shape == LIGHT_RECTANGLE ? 4.0 : PI;
    const vec3 across = cross(light_scale() * view.light_half_u, light_scale() * view.light_half_v);
    const float area = square * abs(dot(across, direction));
    return LightSample(direction, reach, sqrt(area / float(view.shadow_rays)) / reach);
}

// A sample in the cone that the light fills, even in solid angle: 1 - cosine grows with the square of the
// disk's radius.
LightSample cone_sample(LightPlace light, vec3 point, vec2 disk) {
    const bool positional = light.is_positional;
    const vec3 way = positional ? light.at - point : light.at;
    const float far = length(way);
    const float radius = light_scale() * view.light_radius;
    const float sine = min(radius / far, 1.0);
    const float widest = positional ? sine * sine / (1.0 + sqrt(1.0 - sine * sine)) : view.light_cosine_loss;
    const float lost = widest * dot(disk, disk);
    const float across = sqrt(widest * (2.0 - lost));
    const vec3 axis = way / far;
    const vec3 side = normalize(cross(axis, abs(axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    const vec3 direction = normalize((1.0 - lost) * axis + across * (disk.x * side + disk.y * cross(axis, side)));
    const float width = sqrt(2.0 * PI * widest / float(view.shadow_rays));
    if (!positional) return LightSample(direction, ENDLESS, width);
    // The ray ends at the sphere's front: that lies before the ray's point nearest to the middle, by the
    // other leg of a right triangle whose hypotenuse is the radius.
    const float off_axis = far * length(cross(axis, direction));
    const float under = radius * radius - off_axis * off_axis;
    return LightSample(direction, max(dot(direction, way) - sqrt(max(under, 0.0)), 0.0), width);
}

LightSample sample_at(vec3 point, vec2 place) {
    const LightPlace light = light_there();
    if (view.light_shape == LIGHT_RECTANGLE) return flat_sample(light.at, point, 2.0 * place - 1.0);
    if (view.light_shape == LIGHT_DISK) return flat_sample(light.at, point, on_disk(place));
    return cone_sample(light, point, on_disk(place));
}

#if SHADOW_CONES
// Cones have a width. Their middles therefore keep so far from the light's edge that all cones together have
// the light's second moment; a single cone goes to the light's middle. But no cone is wider than the root's
// voxels.
vec2 cone_place(vec3 point, vec2 place) {
#if WINDOWS
    const float kept = 1.0;
#else
    const float root = cell_length(ROOT_SHIFT);
    const float widest = root / float(BRICK_M) / max(distance(point, vec3(0.5 * root)), 1.0);
    const float kept = min(widest / sample_at(point, vec2(0.5)).width, 1.0);
#endif
    return 0.5 + sqrt(1.0 - kept * kept / float(view.shadow_rays)) * (place - 0.5);
}
#endif

LightSample light_sample(vec3 point, ivec2 pixel, uint i) {
#if SHADOW_CONES
    return sample_at(point, cone_place(point, sample_place(pixel, i)));
#else
    return sample_at(point, sample_place(pixel, i));
#endif
}
