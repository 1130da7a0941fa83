// Which pixel's primary ray a thread takes, and where it begins and ends: in the first pass of all pixels of the blocks
// that may see anything, later of the pixels whose rays wait.
#ifdef WITH_PROXY
#include "mesh/proxy_span.glsl"
#endif

layout(local_size_x = PIXEL_BLOCK_SIDE * PIXEL_BLOCK_SIDE) in;

layout(std430, binding = SSBO_BLOCK_STARTS) readonly buffer BlockStartBlock { BlockStart block_starts[]; };

uniform uint ray_count;
uniform bool first_pass;
uniform uint list_in;  // words in lists[]
uniform uint list_out;
uniform uint shadow_list;

RayState state;  // of the thread's ray

struct Launch {
    ivec2 pixel;     // in the band
    uint index;      // of its state
    BlockStart start;
};

#ifdef WITH_MESHES
MeshPixel mesh;  // at the pixel
#endif

// False when the thread has no pixel.
bool find_pixel(out Launch launch) {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    launch = Launch(ivec2(0), 0u, BlockStart(0u, 0.0, 1e30));
    if (i >= ray_count) return false;
    if (first_pass) {
        const int blocks = (view.size_shadow.x + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE;
        launch.start = block_starts[i / uint(PIXEL_BLOCK_SIDE * PIXEL_BLOCK_SIDE)];
        const int block = int(launch.start.block);
        launch.pixel = ivec2(block % blocks, block / blocks) * PIXEL_BLOCK_SIDE + ivec2(i % 4u + 4u * (i / 32u % 2u), i / 4u % 8u);
        if (launch.pixel.x >= view.size_shadow.x || launch.pixel.y >= view.band.y) return false;
    } else {
        const int p = int(lists[list_in + i]);
        launch.pixel = ivec2(p % view.size_shadow.x, p / view.size_shadow.x);
    }
    launch.index = uint(launch.pixel.y * view.size_shadow.x + launch.pixel.x);
    return true;
}

Ray launched_ray(Launch launch, PixelRay seen) {
    Ray ray = make_ray(seen.origin, seen.direction, launch.start.far - seen.skipped, view.eye.w * seen.skipped, view.eye.w);
#if WINDOWS
    ray.from_eye = true;
#endif
#ifdef WITH_MESHES
    mesh = mesh_pixel(launch.pixel);
    ray.t_end = min(ray.t_end, mesh.t);
#endif
#ifdef WITH_PROXY
    ray.t_end = min(ray.t_end, proxy_span_at(launch.pixel).y);
#endif
    return ray;
}

// Puts a new ray where it begins; false when it meets nothing.
bool enter(inout Ray ray, Launch launch, PixelRay seen) {
#ifdef WITH_MESHES
    if (voxels_hidden) return false;
#endif
    ray.t = max(launch.start.near - seen.skipped, 0.0);
#ifdef WITH_PROXY
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

// Brings the pixel's ray to its end; false when it waits for the next pass.
bool march_pixel(Launch launch, PixelRay seen) {
    Ray ray = launched_ray(launch, seen);
    bool inside = true;
    if (first_pass) {
        state.color = vec4(0.0, 0.0, 0.0, 1.0);
        state.normal_depth = vec4(0.0);
        state.voxel_t_weight = uvec4(0u);
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
    state.voxel_t_weight.xy = uvec2(0xFFFFFFFFu);
#if WINDOWS
    state.voxel_t_weight.z = uint(seen_window);
#endif
    rays[index] = state;
    lists[shadow_list + atomicAdd(counters.waiting_shadow, 1u)] = index;
}
