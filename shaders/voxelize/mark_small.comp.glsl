// One thread is one triangle: it marks the triangle if that has few rows, and leaves it to mark_large
// otherwise, or to list_masked if a mask cuts it. Rows in doubt are not decided here, because lanes run in
// lockstep: doubles for one lane cost all lanes dearly. A triangle with such a row goes into a queue, and is
// marked anew by the program with EXACT=1.
#include "interop/surface.h"
#include "interop/voxelize.h"
#include "voxelize/bits.glsl"
#define ANY_VOXEL_SIDE 0
#include "voxelize/exact_triangle.glsl"
#include "voxelize/material.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/row_steps.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

uniform int voxel_shift;
uniform uint count;

#if !EXACT
layout(std430, binding = SSBO_VOXEL_SUBSET) restrict readonly buffer VoxelSubset { uint voxel_subset[]; };
uniform uint first;  // number of the first triangle, or its place in the subset
uniform int has_subset;
uniform int thread_rows;  // about how many rows of a shared triangle each thread marks

// The queue of a triangle that threads share. It is chosen for twice the rows, because rows are shared
// unevenly.
uint shared_queue(RowSteps steps) {
    const float threads = 2.0 * float(steps.count) * float(steps.most_rows) / float(thread_rows);
    uint queue = VOXEL_QUEUE_SHARED;
    float most = float(VOXEL_SHARED_LEAST);
    for (int larger = 1; larger < VOXEL_SHARED_CLASSES; ++larger) {
        if (threads > most) ++queue;
        most *= float(VOXEL_SHARED_FACTOR);
    }
    return queue;
}

// Puts the triangle in a queue if it is left to a later pass. `size`: size of its bounding box in the region.
bool enqueue_if_not_small(ExactTriangle t, uint triangle, uint material, ivec3 size) {
    const float rows = float(size.y) * float(size.z);
    if (is_masked(surface_materials[material])) {
        const bool small = rows * float(size.x) <= VOXEL_MASKED_SMALL_BOX;
        enqueue(small ? VOXEL_QUEUE_MASKED_SMALL : VOXEL_QUEUE_MASKED_LARGE, triangle);
        return true;
    }
    if (rows <= VOXEL_SMALL_ROWS) return false;
    enqueue(shared_queue(row_steps(t, low_in_region(t), high_in_region(t))), triangle);
    return true;
}

// First and last y of a slice's rows in the region.
ivec2 rows_in_region(ExactTriangle t, RowSlice slice, ivec3 low, ivec3 high) {
    const ivec2 rows = rows_of_slice(t, slice);
    return ivec2(max(rows.x, low.y), min(rows.y, high.y));
}
#endif

void main() {
    const uint thread = thread_index();
    if (thread >= count) return;
#if EXACT
    const uint triangle = queued(VOXEL_QUEUE_DOUBT, thread);
#else
    const uint triangle = has_subset != 0 ? voxel_subset[first + thread] : first + thread;
#endif
    const uvec3 corners = surface_triangles[triangle].vertices;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = low_in_region(t);
    const ivec3 high = high_in_region(t);
    const ivec3 size = high - low + 1;
#if !EXACT
    if (any(lessThan(size, ivec3(1)))) return;
    if (enqueue_if_not_small(t, triangle, surface_triangles[triangle].material, size)) return;
#endif
#if EXACT
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) mark_span(ivec2(y, z), exact_row_span(t, ivec2(y, z)));
    }
#else
    // One loop over all rows, not one per slice: lanes run in lockstep, and in nested loops each lane would
    // wait for the slice with the most rows of any lane.
    bool any_doubt = false;
    int z = low.z;
    RowSlice slice = row_slice(t, z);
    ivec2 rows = rows_in_region(t, slice, low, high);
    while (z <= high.z) {
        if (rows.x <= rows.y) {
            bool in_doubt;
            const ivec2 span = filtered_row_span(t, slice, rows.x, in_doubt);
            if (!in_doubt) mark_span(ivec2(rows.x, z), span);
            any_doubt = any_doubt || in_doubt;
            ++rows.x;
        }
        if (rows.x > rows.y) {
            ++z;
            slice = row_slice(t, z);
            rows = rows_in_region(t, slice, low, high);
        }
    }
    if (any_doubt) enqueue(VOXEL_QUEUE_DOUBT, triangle);
#endif
}
