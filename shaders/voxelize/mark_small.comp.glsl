// One thread is one triangle: it marks those of few rows, and leaves the others to mark_large,
// and those that a mask cuts to list_masked.
#include "voxelize/bits.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"

layout(local_size_x = VOXEL_GROUP) in;

layout(std430, binding = SSBO_VOXEL_SUBSET) restrict readonly buffer VoxelSubset { uint voxel_subset[]; };

uniform int voxel_shift;
uniform uint first;      // triangle, or place in the subset
uniform uint count;
uniform int has_subset;

void main() {
    const uint thread = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * VOXEL_GROUP;
    if (thread >= count) return;
    const uint triangle = has_subset != 0 ? voxel_subset[first + thread] : first + thread;
    const uvec4 corners = surface_triangles[triangle].vertices_material;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = max(t.low, region_origin);
    const ivec3 high = min(t.high, region_origin + region_size - 1);
    if (any(greaterThan(low, high))) return;
    const ivec2 size = high.yz - low.yz + 1;
    const float rows = float(size.x) * float(size.y);
    if ((surface_materials[corners.w].flags & (1u << MATERIAL_MASK_BIT)) != 0u) {
        const bool small = rows * float(high.x - low.x + 1) <= VOXEL_MASKED_SMALL_BOX;
        enqueue(small ? VOXEL_QUEUE_MASKED_SMALL : VOXEL_QUEUE_MASKED_LARGE, triangle);
        return;
    }
    if (rows > VOXEL_SMALL_ROWS) {
        enqueue(rows > VOXEL_LARGE_ROWS ? VOXEL_QUEUE_HUGE : VOXEL_QUEUE_LARGE, triangle);
        return;
    }
    // One loop over all rows, not two nested ones: threads side by side have about as many rows, not the same shape.
    ivec2 row = low.yz;
    for (int i = size.x * size.y; i > 0; --i) {
        mark_span(row, row_span(t, row));
        ++row.x;
        if (row.x > high.y) row = ivec2(low.y, row.y + 1);
    }
}
