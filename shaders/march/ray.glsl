// A ray, and its steps from cell to cell.
// Needs cells.glsl, MARCHED_SIDE (side of the cube that rays march, in voxels) and the define WINDOWS.

#define ENDLESS 1e30           // a distance that no ray reaches
#define LEAST_DIRECTION 1e-20  // an axis along which a unit direction has less is inert

struct Ray {
    vec3 origin;
    vec3 direction;       // unit
    vec3 inverse;         // 1 / direction; 0 along inert axes
    // Axes whose planes the ray never crosses: the component is under LEAST_DIRECTION.
    bvec3 inert;
    ivec3 positive;       // 1 along axes where the direction is positive, else 0
    float t;              // distance that the ray has gone
    float t_end;
    ivec3 cell;           // finest cell (cells.glsl) that the ray is in
    float cone_base;      // the cone's width at t is cone_base + cone_slope * t
    float cone_slope;
#if WINDOWS
    // Window that the ray is in; lengths and positions are in its voxels.
    int window;
    bool from_eye;        // `origin` is the eye
#endif
};

Ray make_ray(vec3 origin, vec3 direction, float t_end, float cone_base, float cone_slope) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.inert = lessThan(abs(direction), vec3(LEAST_DIRECTION));
    ray.inverse = mix(1.0 / mix(direction, vec3(1.0), ray.inert), vec3(0.0), ray.inert);
    ray.positive = ivec3(greaterThan(direction, vec3(0.0)));
    ray.t = 0.0;
    ray.t_end = t_end;
    ray.cell = ivec3(0);
    ray.cone_base = cone_base;
    ray.cone_slope = cone_slope;
#if WINDOWS
    ray.window = 0;
    ray.from_eye = false;
#endif
    return ray;
}

ivec3 finest_cell_at(vec3 place) { return ivec3(floor(place * float(1 << MARK_SHIFT))); }

// Moves the ray to where it enters the marched cube, at ray.t or behind; false if it misses the cube.
bool enter_root(inout Ray ray) {
    const vec3 side = vec3(FINEST_LENGTH * float(MARCHED_SIDE));
    const vec3 low = -ray.origin;
    const vec3 high = side - ray.origin;
    // An inert axis bounds nothing when the origin lies between its planes, and everything when it does not.
    const bvec3 outside = notEqual(lessThanEqual(low, vec3(0.0)), greaterThanEqual(high, vec3(0.0)));
    if (any(bvec3(ray.inert.x && outside.x, ray.inert.y && outside.y, ray.inert.z && outside.z))) return false;
    const vec3 ta = mix(low * ray.inverse, vec3(-ENDLESS), ray.inert);
    const vec3 tb = mix(high * ray.inverse, vec3(ENDLESS), ray.inert);
    const vec3 near = min(ta, tb);
    const vec3 far = max(ta, tb);
    const float t_near = max(max(near.x, near.y), max(near.z, ray.t));
    const float t_far = min(far.x, min(far.y, far.z));
    if (t_near > t_far || t_near >= ray.t_end) return false;
    ray.t = t_near;
    ray.cell = clamp(finest_cell_at(clamp(ray.origin + ray.direction * t_near, vec3(0.0), side)), ivec3(0),
                      ivec3(MARCHED_SIDE - 1));
    return true;
}

// Corrects the cell after a start inside the marched cube: rounding may have carried it over a plane that
// the ray, as step_over() computes it, has yet to cross. So a ray that starts late takes the way of one that
// started early.
void stay_behind_planes(inout Ray ray) {
    const bvec3 forward = equal(ray.positive, ivec3(1));
    const vec3 bound = corner_of(mix(ray.cell + 1, ray.cell, forward));
    const vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(-ENDLESS), ray.inert);
    const ivec3 back = mix(ivec3(0), mix(ivec3(1), ivec3(-1), forward), greaterThan(t, vec3(ray.t)));
    ray.cell = clamp(ray.cell + back, ivec3(0), ivec3(MARCHED_SIDE - 1));
}

// Steps over the aligned cell around the ray's finest cell, to the finest cell behind it; false if the ray has left the
// marched cube or come to its end.
bool step_over(inout Ray ray, int shift) {
    const ivec3 low = cell_low(ray.cell, shift);
    const ivec3 high = low + (cell_side(shift) - 1);
    const ivec3 last = mix(low, high, equal(ray.positive, ivec3(1)));  // before the plane where it leaves
    const vec3 bound = corner_of(last + ray.positive);
    const vec3 t = mix((bound - ray.origin) * ray.inverse, vec3(ENDLESS), ray.inert);
    const float t_plane = min(t.x, min(t.y, t.z));
    const float t_exit = max(t_plane, ray.t);
    // Rounding must carry the other coordinates neither out of the cell nor backwards.
    const ivec3 inside = finest_cell_at(ray.origin + ray.direction * t_exit);
    const ivec3 kept = clamp(inside, min(ray.cell, last), max(ray.cell, last));
    const bool x = t.x == t_plane;
    const bool y = !x && t.y == t_plane;
    const ivec3 leaves = ivec3(x, y, !x && !y);
    ray.cell = mix(kept, last + 2 * ray.positive - 1, equal(leaves, ivec3(1)));
    ray.t = t_exit;
    const uvec3 place = uvec3(ray.cell);
    return max(place.x, max(place.y, place.z)) < uint(MARCHED_SIDE) && t_exit < ray.t_end;
}
