// threads_per_triangle threads share a queued triangle: they share its steps (row_steps.glsl) and, if there
// are more threads than steps, the rows of each step.
#include "interop/voxelize.h"
#include "voxelize/bits.glsl"
#define ANY_VOXEL_SIDE 0
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/row_steps.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

uniform int voxel_shift;
uniform uint queue;
uniform uint first;                 // place of the first triangle in the queue
uniform uint count;                 // number of triangles
uniform uint threads_per_triangle;  // a multiple or a part of THREADS_PER_GROUP

// Rows that the filter leaves in doubt are decided some at a time, because lanes run in lockstep: doubles for
// one lane cost all lanes dearly at every turn.
#define DOUBT_CAPACITY 64
ivec2 doubts[DOUBT_CAPACITY];

void main() {
    const uint invocation = thread_index();
    const uint place = invocation / threads_per_triangle;
    if (place >= count) return;
    const uint triangle = queued(queue, first + place);
    const uvec3 corners = surface_triangles[triangle].vertices;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const RowSteps steps = row_steps(t, low_in_region(t), high_in_region(t));
    const int thread_count = int(threads_per_triangle);
    const int thread = int(invocation % threads_per_triangle);
    const int threads_per_step = max(thread_count / steps.count, 1);
    const int share = thread / steps.count;
    if (share >= threads_per_step) return;
    int step = steps.low.x + thread % steps.count;
    ivec2 rows = rows_of_step(t, steps, step) + ivec2(share, 0);
    while (step <= steps.high.x) {
        int doubt_count = 0;
        while (step <= steps.high.x && doubt_count < DOUBT_CAPACITY) {
            if (rows.x <= rows.y) {
                const ivec2 row = row_of(steps, step, rows.x);
                bool in_doubt;
                const ivec2 span = filtered_row_span(t, row, in_doubt);
                if (in_doubt) doubts[doubt_count++] = row;
                else mark_span(row, span);
                rows.x += threads_per_step;
            }
            if (rows.x > rows.y) {
                step += thread_count;
                rows = rows_of_step(t, steps, step) + ivec2(share, 0);
            }
        }
        for (int i = 0; i < doubt_count; ++i) mark_span(doubts[i], exact_row_span(t, doubts[i]));
    }
}
