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
    for (uint i = slice * VOXEL_GROUP + gl_LocalInvocationID.x; i < rows; i += slice_count * VOXEL_GROUP) {
        const ivec2 row = low.yz + ivec2(i % size.x, i / size.x);
        mark_span(row, row_span(t, row));
    }
}
