// A ray, and its steps from cell to cell.
struct Ray {
    vec3 origin;
    vec3 direction;       // unit
    vec3 inverse;         // 1 / direction; 0 where inert
    bvec3 inert;          // the ray never crosses a plane of this axis: the component is 0, -0 or denormal
    ivec3 positive;       // 1 where the direction is positive
    float t;              // distance so far
    float t_end;
    ivec3 voxel;          // finest-level voxel that the ray is in
    float cone_base;      // pixel width at t is cone_base + cone_slope * t
    float cone_slope;
};

Ray make_ray(vec3 origin, vec3 direction, float t_end, float cone_base, float cone_slope) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.inert = lessThan(abs(direction), vec3(1e-20));
    ray.inverse = mix(1.0 / mix(direction, vec3(1.0), ray.inert), vec3(0.0), ray.inert);
    ray.positive = ivec3(greaterThan(direction, vec3(0.0)));
    ray.t = 0.0;
    ray.t_end = t_end;
    ray.voxel = ivec3(0);
    ray.cone_base = cone_base;
    ray.cone_slope = cone_slope;
    return ray;
}

// Width of the ray's cone where it is. Exactly the same wherever it is asked: what a ray compares it with must not depend on
// how a compiler contracts the sum.
float width_at(Ray ray) {
    precise float width = ray.cone_base + ray.cone_slope * ray.t;
    return width;
}

// Puts the ray where it enters the root cube, at ray.t or behind; false when it misses it.
bool enter_root(inout Ray ray) {
    const vec3 side = vec3(float(ROOT_SIDE));
    const vec3 low = -ray.origin;
    const vec3 high = side - ray.origin;
    // An inert axis bounds nothing when the origin lies between its planes, and everything when it does not.
    const bvec3 outside = notEqual(lessThanEqual(low, vec3(0.0)), greaterThanEqual(high, vec3(0.0)));
    if (any(bvec3(ray.inert.x && outside.x, ray.inert.y && outside.y, ray.inert.z && outside.z))) return false;
    const vec3 ta = mix(low * ray.inverse, vec3(-1e30), ray.inert);
    const vec3 tb = mix(high * ray.inverse, vec3(1e30), ray.inert);
    const vec3 near = min(ta, tb);
    const vec3 far = max(ta, tb);
    const float t_near = max(max(near.x, near.y), max(near.z, ray.t));
    const float t_far = min(far.x, min(far.y, far.z));
    if (t_near > t_far || t_near >= ray.t_end) return false;
    ray.t = t_near;
    ray.voxel = clamp(ivec3(floor(clamp(ray.origin + ray.direction * t_near, vec3(0.0), side))), ivec3(0),
                      ivec3(ROOT_SIDE - 1));
    return true;
}

// Steps over the aligned cell around the ray's voxel, to the voxel behind it; false when the ray has
// left the root cube or come to its end.
bool step_over(inout Ray ray, int shift) {
    const ivec3 low = cell_low(ray.voxel, shift);
    const ivec3 high = low + (cell_side(shift) - 1);
    const bvec3 forward = equal(ray.positive, ivec3(1));
    const vec3 bound = vec3(mix(low, high + 1, forward));
    const vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(1e30), ray.inert);
    const float t_exit = max(min(t.x, min(t.y, t.z)), ray.t);
    const bool x = t.x <= t.y && t.x <= t.z;
    const bool y = !x && t.y <= t.z;
    const bvec3 leaves = bvec3(x, y, !x && !y);
    const ivec3 inside = clamp(ivec3(floor(ray.origin + ray.direction * t_exit)), low, high);
    // Rounding must not carry the other coordinates backwards.
    const ivec3 kept = mix(min(inside, ray.voxel), max(inside, ray.voxel), forward);
    ray.voxel = mix(kept, mix(low - 1, high + 1, forward), leaves);
    ray.t = t_exit;
    return all(greaterThanEqual(ray.voxel, ivec3(0))) && all(lessThan(ray.voxel, ivec3(ROOT_SIDE))) && t_exit < ray.t_end;
}
