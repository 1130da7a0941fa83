// Gives each thread the primary ray of a pixel, with its start and end: in the first pass the pixels of all
// blocks that may see anything, in later passes the pixels whose rays wait.
#include "interop/march.h"
#if WITH_PROXY
#include "mesh/proxy_span.glsl"
#endif

#include "common/thread.glsl"

layout(std430, binding = SSBO_BLOCK_STARTS) readonly buffer BlockStartBlock { BlockStart block_starts[]; };

uniform uint ray_count;
uniform bool first_pass;
// First words in lists[] of the list that is read, and of those that are written.
uniform uint list_in;
uniform uint list_out;
uniform uint shadow_list;

RayState state;  // state of the thread's ray

struct Launch {
    ivec2 pixel;     // place in the band
    uint index;      // number of the ray's state
    BlockStart start;
};

#if WITH_MESHES
MeshPixel mesh;  // the mesh at the pixel
#endif

// Finds the thread's pixel; false if there is none.
bool find_pixel(out Launch launch) {
    const uint i = thread_index();
    launch = Launch(ivec2(0), 0u, BlockStart(0u, 0.0, ENDLESS));
    if (i >= ray_count) return false;
    if (first_pass) {
        const int blocks = (view.width + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE;
        launch.start = block_starts[i / uint(PIXEL_BLOCK_SIDE * PIXEL_BLOCK_SIDE)];
        const int block = int(launch.start.block);
        // 32 threads that run together take 4 x 8 pixels.
        launch.pixel = ivec2(block % blocks, block / blocks) * PIXEL_BLOCK_SIDE +
                       ivec2(i % 4u + 4u * (i / 32u % 2u), i / 4u % 8u);
        if (launch.pixel.x >= view.width || launch.pixel.y >= view.row_count) return false;
    } else {
        launch.pixel = pixel_at(lists[list_in + i]);
    }
    launch.index = pixel_index(launch.pixel);
    return true;
}

Ray launched_ray(Launch launch, PixelRay seen) {
    Ray ray = make_ray(seen.origin, seen.direction, launch.start.far - seen.skipped,
                       view.pixel_cone * seen.skipped, view.pixel_cone);
#if WINDOWS
    ray.from_eye = true;
#endif
#if WITH_MESHES
    mesh = mesh_pixel(launch.pixel);
    ray.t_end = min(ray.t_end, mesh.t);
#endif
#if WITH_PROXY
    ray.t_end = min(ray.t_end, proxy_span_at(launch.pixel).y);
#endif
    return ray;
}

// Puts a new ray at its start; false if it meets nothing.
bool enter(inout Ray ray, Launch launch, PixelRay seen) {
#if WITH_MESHES
    if (voxels_hidden) return false;
#endif
    ray.t = max(launch.start.near - seen.skipped, 0.0);
#if WITH_PROXY
    const vec2 span = proxy_span_at(launch.pixel);
    if (span.x >= span.y) return false;
    atomicAdd(counters.launched, 1u);
    ray.t = max(ray.t, span.x);
#endif
    const bool inside = enter_windows(ray);
#if !WINDOWS
    stay_behind_planes(ray);
#endif
    return inside;
}

// Marches the pixel's ray to its end; false if it waits for the next pass.
bool march_pixel(Launch launch, PixelRay seen) {
    Ray ray = launched_ray(launch, seen);
    bool inside = true;
    if (first_pass) {
        state = new_ray_state();
        inside = enter(ray, launch, seen);
    } else {
        state = rays[launch.index];
        load_position(ray, state);
    }
    const int end = inside ? march(ray) : MARCH_DONE;
    leave_report(launch.index);
    if (end != MARCH_MISSING) return true;
    store_position(state, ray);
    rays[launch.index] = state;
    lists[list_out + atomicAdd(counters.waiting_primary, 1u)] = launch.index;
    return false;
}

// Leaves the pixel to a shadow ray, which has not started.
void leave_to_shadow_ray(uint index) {
    store_not_started(state);
    rays[index] = state;
    lists[shadow_list + atomicAdd(counters.waiting_shadow, 1u)] = index;
}
