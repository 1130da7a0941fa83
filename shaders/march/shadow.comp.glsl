// One thread is one waiting shadow ray: from what a primary ray saw, to the light.
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=0 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=0 BLENDED=0
// defines: TREE_N=4 BRICK_M=16 BRICK_MIPS=2 MAX_LEVEL=4 HAS_COLOR=1 PROGRESSIVE=1 BLENDED=1
// defines: TREE_N=2 BRICK_M=8 BRICK_MIPS=1 MAX_LEVEL=7 HAS_COLOR=0 PROGRESSIVE=0 BLENDED=1
// defines: TREE_N=4 BRICK_M=64 BRICK_MIPS=2 MAX_LEVEL=0 HAS_COLOR=0 PROGRESSIVE=1 BLENDED=0
#include "march/march.glsl"
#include "march/shade.glsl"

layout(local_size_x = 64) in;

uniform uint ray_count;
uniform uint list_in;
uniform uint list_out;

float visibility;

// The receiver: a voxel near its tangent plane, and near it, is its own surface and casts no shadow on it.
vec3 receiver;
vec3 receiver_normal;
float own_side;  // of the voxels that the receiver is shown with; of the finer ones, when they are blended
float own_height;
float own_reach;
float receiver_rise;  // of the ray over that plane, for each unit of its length

#define OWN_HEIGHT 1.75  // in voxels
float own_reach_of(float side) { return side * clamp(2.5 / receiver_rise, 8.0, 64.0); }

bool visit(inout Ray ray, Sample s) {
    float height = own_height;
    float reach = own_reach;
#if PROGRESSIVE || BLENDED
    if (s.side > own_side) {  // what stands in, and the coarser of two mips, are larger than the receiver's finest
        height = max(height, OWN_HEIGHT * s.side);
        reach = max(reach, own_reach_of(s.side));
    }
#endif
    const bool own = s.t < reach && dot(s.centre - receiver, receiver_normal) < height;
    if (!own) visibility = behind(visibility, coverage_of(s), s.share);
    return visibility > OPAQUE_TRANSMITTANCE;
}

// Side of the voxels that a cone of this width is shown with (see march()).
float voxel_side(float width) {
    int own_shift = ROOT_SHIFT - M_SHIFT;
    for (int level = 0; level < MAX_LEVEL && float(cell_side(own_shift)) > width; ++level) own_shift -= N_SHIFT;
    return float(cell_side(own_shift + mip_for(own_shift, width)));
}

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= ray_count) return;
    const uint index = lists[list_in + i];
    const ivec2 pixel = ivec2(int(index) % view.size_shadow.x, int(index) / view.size_shadow.x);
    RayState state = rays[index];

    const PixelRay seen = pixel_ray(pixel);
    const float width = view.eye.w * (seen.skipped + state.normal_depth.w);
    const float side = voxel_side(width);
    receiver = seen.origin + seen.direction * state.normal_depth.w;
    receiver_normal = facing_normal(state, seen.direction);
    const vec3 to_light = direction_to_light(receiver);
    // The receiver's plane may lie half a voxel's diagonal from the point, and its voxels as far from the plane. A ray
    // at a low angle stays among them for longer.
    receiver_rise = max(dot(receiver_normal, to_light), 1e-3);
    own_side = side;
    own_height = OWN_HEIGHT * side;
    own_reach = own_reach_of(side);

    const float reach = view.light.w > 0.5 ? distance(view.light.xyz, receiver) : 1e30;
    Ray ray = make_ray(receiver, to_light, reach, width, 0.0);
    bool inside = true;
    if (all(equal(state.voxel_t_weight.xy, uvec2(0xFFFFFFFFu)))) {
        visibility = 1.0;
        // Until here all voxels are its own: those that are not lie at least half a diagonal under their centres.
        ray.t = min(0.88 * side / receiver_rise, own_reach);
        inside = enter_root(ray);
    } else {
        load_position(ray, state);
        visibility = uintBitsToFloat(state.voxel_t_weight.w);
    }

    if (inside && march(ray) == MARCH_MISSING) {
        store_position(state, ray);
        state.voxel_t_weight.w = floatBitsToUint(visibility);
        rays[index] = state;
        lists[list_out + atomicAdd(counters.waiting_shadow, 1u)] = index;
        return;
    }
    write_pixel(pixel, state, visibility > OPAQUE_TRANSMITTANCE ? visibility : 0.0);
}
