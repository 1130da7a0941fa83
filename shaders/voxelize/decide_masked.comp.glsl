// One thread is one candidate: it marks the voxel if the mask leaves surface in it.
#include "interop/voxelize.h"
#include "voxelize/alpha_mask.glsl"
#include "voxelize/bits.glsl"
#include "voxelize/candidates.glsl"
#include "common/thread.glsl"

uniform int voxel_shift;

void main() {
    const uint thread = thread_index();
    if (thread >= candidate_count) return;
    const ivec4 candidate = candidates[thread];
    if (is_marked(candidate.xyz)) return;
    const int answer = mask_decide(masked_triangle(uint(candidate.w)), candidate.xyz, voxel_shift);
    if (answer == MASK_SURFACE) mark_span(candidate.yz, ivec2(candidate.x));
    if (answer == MASK_UNDECIDED) {
        candidates[thread].w = -1 - candidate.w;
        atomicAdd(undecided_count, 1u);
    }
}
