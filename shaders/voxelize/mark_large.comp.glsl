// A workgroup is one slice of one queued triangle, of slice_count; a thread takes every (slice_count * VOXEL_GROUP)th
// row of the triangle's bounding box.
#include "voxelize/bits.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"

layout(local_size_x = VOXEL_GROUP) in;

uniform int voxel_shift;
uniform uint queue;
uniform uint first;        // place in the queue
uniform uint slice_count;

void main() {
    const uint slice = gl_WorkGroupID.x;
    const uint triangle = queued(queue, first + gl_WorkGroupID.y);
    const uvec4 corners = surface_triangles[triangle].vertices_material;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = max(t.low, region_origin);
    const ivec3 high = min(t.high, region_origin + region_size - 1);
    const uvec2 size = uvec2(high.yz - low.yz + 1);
    const uint rows = size.x * size.y;
    const uint stride = slice_count * VOXEL_GROUP;
    uvec2 doubts = uvec2(0u);  // one bit a turn; a thread has at most 64 rows
    uint turn = 0u;
    for (uint i = slice * VOXEL_GROUP + gl_LocalInvocationID.x; i < rows; i += stride, ++turn) {
        const ivec2 row = low.yz + ivec2(i % size.x, i / size.x);
        bool in_doubt;
        const ivec2 span = filtered_row_span(t, row, in_doubt);
        if (!in_doubt) mark_span(row, span);
        else if (turn < 32u) doubts.x |= 1u << turn;
        else doubts.y |= 1u << (turn - 32u);
    }
    // Apart, because lanes run in lockstep: doubles for one would cost all of them dearly at every turn.
    while ((doubts.x | doubts.y) != 0u) {
        const bool early = doubts.x != 0u;
        const uint bits = early ? doubts.x : doubts.y;
        const uint i = (slice * VOXEL_GROUP + gl_LocalInvocationID.x) + stride * uint(findLSB(bits) + (early ? 0 : 32));
        const ivec2 row = low.yz + ivec2(i % size.x, i / size.x);
        mark_span(row, exact_row_span(t, row));
        if (early) doubts.x &= bits - 1u;
        else doubts.y &= bits - 1u;
    }
}
