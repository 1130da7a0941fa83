// A workgroup is one slice of one queued triangle, of slice_count; a thread takes every (slice_count * VOXEL_GROUP)th
// row of the triangle's bounding box.
// defines: MASKED=0
// defines: MASKED=1
#include "voxelize/bits.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"
#if MASKED
#include "voxelize/alpha_mask.glsl"
#endif

layout(local_size_x = VOXEL_GROUP) in;

uniform int voxel_shift;
uniform uint queue;
uniform uint first;        // place in the queue
uniform uint slice_count;

#if MASKED
void mark_masked_span(MaskedTriangle m, ivec2 row, ivec2 span) {
    const ivec2 cut = ivec2(max(span.x, region_origin.x), min(span.y, region_origin.x + region_size.x - 1));
    for (int x = cut.x; x <= cut.y; ++x) {
        if (mask_touches(m, ivec3(x, row), voxel_shift)) mark_span(row, ivec2(x));
    }
}
#endif

void main() {
    const uint slice = gl_WorkGroupID.x;
    const uint triangle = queued(queue, first + gl_WorkGroupID.y);
    const uvec4 corners = surface_triangles[triangle].vertices_material;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
#if MASKED
    const MaskedTriangle m = masked_triangle(triangle);
#endif
    const ivec3 low = max(t.low, region_origin);
    const ivec3 high = min(t.high, region_origin + region_size - 1);
    const uvec2 size = uvec2(high.yz - low.yz + 1);
    const uint rows = size.x * size.y;
    for (uint i = slice * VOXEL_GROUP + gl_LocalInvocationID.x; i < rows; i += slice_count * VOXEL_GROUP) {
        const ivec2 row = low.yz + ivec2(i % size.x, i / size.x);
        const ivec2 span = row_span(t, row);
#if MASKED
        mark_masked_span(m, row, span);
#else
        mark_span(row, span);
#endif
    }
}
