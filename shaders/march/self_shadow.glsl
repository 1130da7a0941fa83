// The receiver of a shadow ray does not shadow itself: a voxel near the receiver's tangent plane, and near
// the receiver, is part of the receiver's surface.
#define VOXEL_HALF_DIAGONAL 0.87  // in sides of the voxel; half of sqrt(3) is a little less
#define LEAST_RECEIVER_RISE 1e-3  // lower rays are taken to rise so much
// The distance along the ray up to which voxels may be the receiver's is SELF_SHADOW_CLIMB / receiver_rise
// within two limits, in sides of a voxel: a ray at a low angle stays longer among them.
#define SELF_SHADOW_CLIMB 2.5
#define SELF_SHADOW_LEAST_REACH 8.0
#define SELF_SHADOW_MOST_REACH 64.0

vec3 receiver;
vec3 receiver_normal;
// Voxels whose centres lie lower over the tangent plane may be the receiver's.
float self_shadow_height;
// Voxels that the ray meets before this distance may be the receiver's.
float self_shadow_reach;
// Rise of the ray over the tangent plane, per unit of the ray's length.
float receiver_rise;

float self_shadow_reach_of(float side) {
    return side * clamp(SELF_SHADOW_CLIMB / receiver_rise, SELF_SHADOW_LEAST_REACH, SELF_SHADOW_MOST_REACH);
}

// For a ray from the receiver through voxels of this side. The receiver's plane may lie half a voxel's
// diagonal from the receiver, and its voxels as far from the plane.
void look_to_light(vec3 to_light, float side) {
    receiver_rise = max(dot(receiver_normal, to_light), LEAST_RECEIVER_RISE);
    self_shadow_reach = self_shadow_height > 0.0 ? self_shadow_reach_of(side) : 0.0;
}

// All voxels that the ray meets before this distance are the receiver's: the others lie at least half a
// diagonal under their centres.
float self_shadow_end(float side) {
    return min(max(self_shadow_height - VOXEL_HALF_DIAGONAL * side, 0.0) / receiver_rise, self_shadow_reach);
}

// Is a voxel part of the receiver's surface? Its centre lies at `from_receiver`, and the ray meets it at `t`.
bool is_receiver_voxel(vec3 from_receiver, float t, float height, float reach) {
    return t < reach && dot(from_receiver, receiver_normal) < height;
}
