// The receiver of a shadow ray: a voxel near its tangent plane, and near it, is its own surface and casts no
// shadow on it.
vec3 receiver;
vec3 receiver_normal;
float own_height;
float own_reach;
float receiver_rise;  // of the ray over that plane, for each unit of its length

float own_reach_of(float side) { return side * clamp(2.5 / receiver_rise, 8.0, 64.0); }

// For a ray from the receiver through voxels of this side. The receiver's plane may lie half a voxel's
// diagonal from the point, and its voxels as far from the plane. A ray at a low angle stays among them for
// longer.
void look_to_light(vec3 to_light, float side) {
    receiver_rise = max(dot(receiver_normal, to_light), 1e-3);
    own_reach = own_height > 0.0 ? own_reach_of(side) : 0.0;
}

// Until here all voxels are its own: those that are not lie at least half a diagonal under their centres.
float own_end(float side) { return min(max(own_height - 0.87 * side, 0.0) / receiver_rise, own_reach); }

bool is_own(vec3 from_receiver, float t, float height, float reach) {
    return t < reach && dot(from_receiver, receiver_normal) < height;
}
