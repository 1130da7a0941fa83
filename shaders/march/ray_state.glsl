// A ray between two passes: how RayState holds its place.
#include "interop/march.h"

RayState new_ray_state() {
    return RayState(vec4(0.0, 0.0, 0.0, 1.0), vec3(0.0), 0.0, uvec2(0u), 0.0, 0.0);
}

// Whether the ray has started. The shadow ray of a pixel has not, right after the primary ray's end.
bool has_started(RayState state) { return (state.place.y & RAY_NOT_STARTED) == 0u; }

// Notes the depth of the voxel if it weighs most so far in the pixel. @return whether it does.
bool note_heaviest(inout RayState state, float weight, float depth) {
    if (!(weight > state.weight)) return false;
    state.weight = weight;
    state.depth = depth;
    return true;
}

#if WINDOWS
// 17 bits per coordinate, then 6 for the ray's window and 6 for the window of the seen voxel. The last bit
// marks a ray that has not started.
uvec2 pack_place(ivec3 v, int window) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 17, u.y >> 15 | u.z << 2 | uint(window) << 19 | uint(seen_window) << 25);
}

void store_not_started(inout RayState state) {
    state.place = uvec2(0u, RAY_NOT_STARTED | uint(seen_window) << 25);
}

void store_position(inout RayState state, Ray ray) {
    state.place = pack_place(ray.cell, ray.window);
    state.distance = ray.t;
}

int stored_seen_window(RayState state) { return int(state.place.y >> 25 & 63u); }

// Moves a ray, given as it started and in the window where it started, to its stored place.
void load_position(inout Ray ray, RayState state) {
    const uvec2 p = state.place;
    const int window = int(p.y >> 19 & 63u);
    while (ray.window < window) coarsen(ray);
    ray.cell = ivec3(p.x & 0x1FFFFu, p.x >> 17 | (p.y & 3u) << 15, p.y >> 2 & 0x1FFFFu);
    ray.t = state.distance;
    seen_window = stored_seen_window(state);
}
#else
// 21 bits per coordinate. The last bit marks a ray that has not started.
uvec2 pack_voxel(ivec3 v) {
    const uvec3 u = uvec3(v);
    return uvec2(u.x | u.y << 21, u.y >> 11 | u.z << 10);
}
ivec3 unpack_voxel(uvec2 p) {
    return ivec3(p.x & 0x1FFFFFu, p.x >> 21 | (p.y & 0x3FFu) << 11, p.y >> 10 & 0x1FFFFFu);
}

void store_not_started(inout RayState state) { state.place = uvec2(0u, RAY_NOT_STARTED); }

void store_position(inout RayState state, Ray ray) {
    state.place = pack_voxel(ray.cell);
    state.distance = ray.t;
}

void load_position(inout Ray ray, RayState state) {
    ray.cell = unpack_voxel(state.place);
    ray.t = state.distance;
}
#endif
