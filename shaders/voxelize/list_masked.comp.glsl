// One thread is one of slice_count slices of a queued triangle that a mask cuts. It lists the voxels of every
// slice_count-th row, except those that are marked already.
#include "interop/voxelize.h"
#include "voxelize/bits.glsl"
#include "voxelize/candidates.glsl"
#define ANY_VOXEL_SIDE 0
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

uniform int voxel_shift;
uniform uint queue;
uniform uint first;        // place of the first triangle in the queue
uniform uint count;        // number of triangles
uniform uint slice_count;
uniform uvec2 row_range;   // rows of the triangle's bounding box: first, last + 1

void main() {
    const uint thread = thread_index();
    if (thread >= count * slice_count) return;
    const uint triangle = queued(queue, first + thread / slice_count);
    const uvec3 corners = surface_triangles[triangle].vertices;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = max(t.low, region_origin);
    const ivec3 high = min(t.high, region_origin + region_size - 1);
    const uvec2 size = uvec2(high.yz - low.yz + 1);
    const uint end = min(size.x * size.y, row_range.y);
    for (uint i = row_range.x + thread % slice_count; i < end; i += slice_count) {
        const ivec2 row = low.yz + ivec2(i % size.x, i / size.x);
        const ivec2 span = row_span(t, row);
        for (int x = max(span.x, low.x); x <= min(span.y, high.x); ++x) {
            if (is_marked(ivec3(x, row))) continue;
            const uint place = atomicAdd(candidate_count, 1u);
            if (place < uint(candidates.length())) candidates[place] = ivec4(x, row, triangle);
        }
    }
}
