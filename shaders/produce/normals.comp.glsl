// One thread is one record of a new brick: it turns the gathered normals into those of the voxel, and clears the
// sums that its slab takes the place of.
#include "produce/records.glsl"
#include "produce/two_normals.glsl"
#include "common/thread.glsl"

// Mean of the three sums from word `first` on.
vec3 mean_of(uint first, float weight) {
    return vec3(int(scratch[first]), int(scratch[first + 1u]), int(scratch[first + 2u])) / (weight * NORMAL_UNIT);
}

#define LEAST_NORMAL 1e-3  // a shorter normal is none

uint packed_normals(uint sums) {
    const float weight = float(min(scratch[sums + SUM_WEIGHT], WEIGHT_LIMIT));
    const vec3 mean = mean_of(sums + SUM_NORMAL, weight);
    const vec3 x = mean_of(sums + SUM_MOMENTS, weight);  // xx, xy, xz
    const vec3 y = mean_of(sums + SUM_MOMENTS + 2u, weight);  // xz, yy, yz
    const float zz = max(1.0 - x.x - y.y, 0.0);
    const Normals found = two_normals(mean, mat3(x, vec3(x.y, y.y, y.z), vec3(x.z, y.z, zz)));
    return length(found.first) > LEAST_NORMAL ? pack_normals(found) : 0u;
}

void main() {
    const uint i = thread_index();
    if (i >= record_count) return;
    const Record record = find_record(i);
    const uvec2 marks = marks_of(record);
    // With alpha masks, a voxel of a mip may be occupied because a finer voxel in it is.
    if ((marks.x | marks.y) == 0u) return;
    const uint sums = sums_of(record);
    const uint normals = packed_normals(sums);
    scratch[sums + PACKED_NORMALS] = normals;
    scratch[sums + SLAB_REACH] = 0u;
    scratch[sums + SLAB_REACH + 1u] = 0u;
}
