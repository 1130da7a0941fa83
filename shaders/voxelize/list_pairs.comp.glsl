// Lists pairs of a triangle and an occupied voxel that it touches, for the voxels whose ranks lie in `part`.
// A row in doubt is listed as far as the triangle may touch voxels: gather_attributes finds no piece of the
// triangle in the others.
// LARGE=0: one thread is one triangle; a triangle with a large box is put in the queue.
// LARGE=1: one thread is one of slice_count slices of a queued triangle; it lists every slice_count-th row of
// row_range.
#include "interop/voxelize.h"
#include "voxelize/attribute_pairs.glsl"
#define ANY_VOXEL_SIDE 0
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"
#include "common/thread.glsl"

layout(std430, binding = SSBO_VOXEL_BITS) restrict readonly buffer VoxelBits { uint voxel_bits[]; };
layout(std430, binding = SSBO_ATTRIBUTE_RANKS) restrict readonly buffer RankBlock { uint ranks[]; };

uniform ivec3 region_origin;
uniform ivec3 region_size;
uniform int voxel_shift;
uniform ivec2 part_slices;  // first and last z of the part, in the region
uniform uvec2 part;         // first rank, and one past the last

// Number of the first triangle, or its place in the subset or in the queue.
uniform uint first;
uniform uint count;  // number of triangles
#if LARGE
uniform uint slice_count;
uniform uvec2 row_range;
#else
layout(std430, binding = SSBO_ATTRIBUTE_SUBSET) restrict readonly buffer SubsetBlock { uint subset[]; };
uniform int has_subset;
#endif

void list_voxel(ivec3 place, uint triangle) {
    const uint word = uint((place.z * region_size.y + place.y) * ((region_size.x + 31) >> 5) + (place.x >> 5));
    const uint bit = 1u << uint(place.x & 31);
    const uint bits = voxel_bits[word];
    if ((bits & bit) == 0u) return;
    uint rank = ranks[word / VOXEL_RANK_WORDS] + uint(bitCount(bits & (bit - 1u)));
    for (uint i = word - word % VOXEL_RANK_WORDS; i < word; ++i) rank += uint(bitCount(voxel_bits[i]));
    if (rank < part.x || rank >= part.y) return;
    const uint pair = atomicAdd(pair_count, 1u);
    if (pair >= uint(pairs.length())) return;
    pairs[pair] = uvec4(uint(place.x) | uint(place.y) << 16, uint(place.z), rank - part.x, triangle);
}

void list_row(ExactTriangle t, RowSlice slice, ivec3 low, ivec3 high, ivec2 row, uint triangle) {
    bool in_doubt;
    const ivec2 filtered = filtered_row_span(t, slice, row.x, in_doubt);
    const ivec2 span = t.filtered ? filtered : ivec2(t.low.x, t.high.x);
    for (int x = max(span.x, low.x); x <= min(span.y, high.x); ++x) list_voxel(ivec3(x, row) - region_origin, triangle);
}

void main() {
    const uint thread = thread_index();
#if LARGE
    if (thread >= count * slice_count) return;
    const uint triangle = queued(0u, first + thread / slice_count);
#else
    if (thread >= count) return;
    const uint triangle = has_subset != 0 ? subset[first + thread] : first + thread;
#endif
    const uvec3 corners = surface_triangles[triangle].vertices;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = max(t.low, region_origin + ivec3(0, 0, part_slices.x));
    const ivec3 high = min(t.high, region_origin + ivec3(region_size.xy - 1, part_slices.y));
    const ivec3 size = high - low + 1;
    if (any(lessThan(size, ivec3(1)))) return;
#if LARGE
    const uint end = min(uint(size.y) * uint(size.z), row_range.y);
    for (uint i = row_range.x + thread % slice_count; i < end; i += slice_count) {
        const ivec2 row = low.yz + ivec2(i % uint(size.y), i / uint(size.y));
        list_row(t, row_slice(t, row.y), low, high, row, triangle);
    }
#else
    if (float(size.x) * float(size.y) * float(size.z) > float(min(ATTRIBUTE_SMALL_BOX, pairs.length()))) {
        enqueue(0u, triangle);
        return;
    }
    for (int z = low.z; z <= high.z; ++z) {
        const RowSlice slice = row_slice(t, z);
        const ivec2 rows = rows_of_slice(t, slice);
        for (int y = max(rows.x, low.y); y <= min(rows.y, high.y); ++y) {
            list_row(t, slice, low, high, ivec2(y, z), triangle);
        }
    }
#endif
}
