// The light that a voxel of a volume emits and absorbs along a ray: the integral of a transfer function along
// the ray's chord in the voxel.
//
// Densities are interpolated trilinearly between the centres of voxels. Along each step of a chord they are
// taken as linear, and the emission and absorption of a linear density are looked up in a table
// (pre-integration: Engel, Kraus and Ertl 2001, section 3). Opacity is 1 - exp(-extinction * length), in
// world units, so it depends on no step.
//
// Needs the define VOLUME_STEPS: steps per chord of a voxel.
#include "interop/volume.h"
layout(binding = TEXTURE_TRANSFER) uniform sampler2D transfer;
layout(std140, binding = UBO_VOLUME) uniform VolumeBlock { VolumeView volume; };

// Densities of a voxel and its neighbours: columns are y, rows x. Neighbours outside the brick are in its
// border.
struct Neighbours {
    mat3 below;  // z - 1
    mat3 level;
    mat3 above;
};

float density(ivec3 texel) { return texelFetch(brick_color, texel, 0).r; }

mat3 slice_of(ivec3 p) {
    return mat3(density(p), density(p + ivec3(1, 0, 0)), density(p + ivec3(2, 0, 0)),
                density(p + ivec3(0, 1, 0)), density(p + ivec3(1, 1, 0)), density(p + ivec3(2, 1, 0)),
                density(p + ivec3(0, 2, 0)), density(p + ivec3(1, 2, 0)), density(p + ivec3(2, 2, 0)));
}

Neighbours neighbours_of(Sample s) {
    const ivec3 p = s.texel + s.voxel;
    return Neighbours(slice_of(p), slice_of(p + ivec3(0, 0, 1)), slice_of(p + ivec3(0, 0, 2)));
}

float mixed(Neighbours v, vec3 x, vec3 y, vec3 z) {
    return dot(vec3(dot(x * v.below, y), dot(x * v.level, y), dot(x * v.above, y)), z);
}

// Weights of the neighbours before, at and behind, for a place in [-0.5, 0.5] from the voxel's centre:
// trilinear interpolation, whichever side of the centre the place is on.
vec3 weights(float u) { return vec3(max(-u, 0.0), 1.0 - abs(u), max(u, 0.0)); }
// Weights, likewise, of the difference between the densities half a voxel behind and half a voxel before the
// place.
vec3 differences(float u) { return vec3(u - 0.5, -2.0 * u, u + 0.5); }

float density_at(Neighbours v, vec3 u) { return mixed(v, weights(u.x), weights(u.y), weights(u.z)); }

// Gradient, in densities per voxel.
vec3 gradient_at(Neighbours v, vec3 u) {
    const vec3 x = weights(u.x);
    const vec3 y = weights(u.y);
    const vec3 z = weights(u.z);
    return vec3(mixed(v, differences(u.x), y, z), mixed(v, x, differences(u.y), z), mixed(v, x, y, differences(u.z)));
}

// Mean emission and extinction per world unit, while the density goes from s0 to s1.
vec4 mean_optics(float s0, float s1) {
    const vec2 place = clamp(vec2(s0, s1), 0.0, 1.0) * float(DENSITY_STEPS - 1);
    const ivec2 low = min(ivec2(place), DENSITY_STEPS - 2);
    const vec2 f = place - vec2(low);
    return mix(mix(texelFetch(transfer, low, 0), texelFetch(transfer, low + ivec2(1, 0), 0), f.x),
               mix(texelFetch(transfer, low + ivec2(0, 1), 0), texelFetch(transfer, low + ivec2(1, 1), 0), f.x), f.y);
}

// The chord of a ray in a voxel, cut in VOLUME_STEPS steps. Lengths are in voxels of the finest level.
struct Chord {
    // Middle of the chord relative to the voxel's centre, in voxels of the level.
    vec3 middle;
    vec3 direction;  // voxels of the level per voxel of the finest level
    float from;      // start of the chord, relative to its middle
    float step;      // length of a step
};

// The chord in a voxel that `ray` has stepped over (march()).
Chord chord_of(Ray ray, Sample s) {
    Chord chord;
    chord.from = s.t - ray.t;
    chord.step = max(min(ray.t, ray.t_end) - s.t - chord.from, 0.0) / float(VOLUME_STEPS);
    chord.middle = s.middle - (vec3(s.voxel) + 0.5);
    chord.direction = ray.direction / s.voxel_side;
    return chord;
}

// Density after a number of steps from the start of the chord.
float density_on(Chord chord, Neighbours v, float steps) {
    return density_at(v, clamp(chord.middle + (chord.from + steps * chord.step) * chord.direction, -0.5, 0.5));
}

// Mean emission and extinction along a step on which the density goes from s0 over s1 to s2. The results for
// two straight halves and for one straight whole are extrapolated to ever finer parts (Richardson's
// extrapolation).
vec4 step_optics(float s0, float s1, float s2) {
    const vec4 halves = 0.5 * (mean_optics(s0, s1) + mean_optics(s1, s2));
    return max((4.0 * halves - mean_optics(s0, s2)) / 3.0, vec4(0.0));
}
