// Steps through the rows of a large triangle along the longer of y and z, so that rows which it cannot meet
// cost nothing.
#include "voxelize/bits.glsl"
#include "voxelize/exact_triangle.glsl"

ivec3 low_in_region(ExactTriangle t) { return max(t.low, region_origin); }
ivec3 high_in_region(ExactTriangle t) { return min(t.high, region_origin + region_size - 1); }

struct RowSteps {
    bool along_z;
    ivec2 low, high;  // x: along the steps; y: across; in the region
    int count;        // number of steps
    int most_rows;    // greatest number of rows in a step
};

RowSteps row_steps(ExactTriangle t, ivec3 low, ivec3 high) {
    RowSteps steps;
    const ivec2 size = t.high.yz - t.low.yz + 1;
    steps.along_z = size.y > size.x;
    steps.low = steps.along_z ? low.zy : low.yz;
    steps.high = steps.along_z ? high.zy : high.yz;
    steps.count = steps.high.x - steps.low.x + 1;
    // Across the steps, a triangle is at most as wide as twice its area over its length. It lies beside its
    // longest edge, which shifts by at most one row in a step. The rest allows for closed voxels at both ends
    // and for rounding.
    const float unit = 1.0 / float(1 << t.shift);
    const float twice_area = float(abs(t.normal.x)) * unit * unit;
    const float widest = t.filtered ? twice_area / max(float(max(size.x, size.y)) - 2.0, 1.0) + 6.0 : FAR_AWAY;
    steps.most_rows = int(min(widest, float(steps.high.y - steps.low.y + 1)));
    return steps;
}

// The first and last row of a step, across, that the triangle may meet.
ivec2 rows_of_step(ExactTriangle t, RowSteps steps, int step) {
    const ivec2 all = ivec2(steps.low.y, steps.high.y);
    if (!t.filtered) return all;
    const int origin = steps.along_z ? t.low.y : t.low.z;
    const float along = float(step - (steps.along_z ? t.low.z : t.low.y));
    const vec3 rest = (steps.along_z ? t.side_z : t.side_y) * along + t.side_offset;
    const vec2 range = rows_inside_sides(steps.along_z ? t.side_y : t.side_z, rest);
    const vec2 limits = vec2(all - origin);
    return ivec2(max(range.x, limits.x), min(range.y, limits.y)) + origin;
}

ivec2 row_of(RowSteps steps, int step, int across) { return steps.along_z ? ivec2(across, step) : ivec2(step, across); }
