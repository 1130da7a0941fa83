// One thread is one pixel of a rasterized mesh: it sends rays from the mesh to samples of the light, through
// the xy-reduced pyramid (Forest et al. 2009, section 3.1). A thread with many rays may pause between two of
// them, and goes on in the next pass.
#include "interop/columns.h"
#include "interop/march.h"

layout(std140, binding = UBO_VIEW) uniform ViewBlock { MarchView view; };
layout(std430, binding = SSBO_COLUMN_COUNTS) buffer CountBlock { uint paused; };

#define WITH_MESHES 1
#define SHADOW_CONES 0
#include "common/thread.glsl"
#include "shadow/trace_columns.glsl"
#include "march/self_shadow.glsl"
#include "march/shade.glsl"
#include "march/shadow_rays.glsl"

uniform bool first_pass;

#define ALL_RAYS 0xFFFFFFFFu  // ShadowSum.ray: the pixel is done

bool visit_voxel(ivec3 voxel, float t) {
    return is_receiver_voxel(vec3(voxel) + 0.5 - receiver, t, self_shadow_height, self_shadow_reach);
}

// A pixel may pause between two rays; a single ray takes few turns.
bool pauses_before_ray() {
    if (shadow_turns > TURN_BUDGET) return true;
    ++shadow_turns;
    return false;
}

// 0 for samples under the receiver's horizon, which do not light it.
float weight_of(inout LightSample there) { return dot(receiver_normal, there.direction) > 0.0 ? 1.0 : 0.0; }

float end_of_occluders(vec3 to_light) { return ENDLESS; }

bool trace_one(LightSample there, bool starts) {
    look_to_light(there.direction, 1.0);
    Ray ray = make_ray(receiver, there.direction, there.reach, 0.0, 0.0);
    ray.t = self_shadow_end(1.0);
    visibility = trace_columns(ray, shadow_turns) ? 0.0 : 1.0;
    return true;
}

void main() {
    const uint index = thread_index();
    if (index >= uint(view.width * view.row_count)) return;
    if (!first_pass && shadow_sums[index].ray == ALL_RAYS) return;
    const ivec2 pixel = pixel_at(index);
    const PixelRay seen = pixel_ray(pixel);
    const MeshPixel mesh = mesh_pixel(pixel);
    visibility = 1.0;
    if (mesh_needs_shadow_ray(mesh, seen, 1.0)) {
        receiver = mesh_point(mesh, seen);
        receiver_normal = mesh.plane;
        self_shadow_height = mesh_self_shadow_height;
        if (!find_light(pixel, index, first_pass)) {
            atomicAdd(paused, 1u);
            return;
        }
    }
    shadow_sums[index].ray = ALL_RAYS;
    write_pixel(pixel, new_ray_state(), visibility, mesh, visibility);  // no voxels are shown
}
