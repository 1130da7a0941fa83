// Lists which triangles touch which occupied voxels of a part: those whose ranks lie in `part`.
// LARGE=0: a thread is one triangle; one with a large box it leaves in the queue.
// LARGE=1: a thread is one slice of one queued triangle, of slice_count; it lists every slice_count-th row of row_range.
// defines: LARGE=0
// defines: LARGE=1
#include "voxelize/attribute_pairs.glsl"
#include "voxelize/exact_triangle.glsl"
#include "voxelize/queue.glsl"
#include "voxelize/surface.glsl"

layout(local_size_x = VOXEL_GROUP) in;

layout(std430, binding = SSBO_VOXEL_BITS) restrict readonly buffer VoxelBits { uint voxel_bits[]; };
layout(std430, binding = SSBO_ATTRIBUTE_RANKS) restrict readonly buffer RankBlock { uint ranks[]; };

uniform ivec3 region_origin;
uniform ivec3 region_size;
uniform int voxel_shift;
uniform ivec2 part_slices;  // first and last z of the part, in the region
uniform uvec2 part;         // ranks: first, last + 1

uniform uint first;  // triangle, place in the subset, or place in the queue
uniform uint count;  // of triangles
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
    if (pair >= ATTRIBUTE_PAIRS) return;
    pairs[pair] = uvec4(uint(place.x) | uint(place.y) << 16, uint(place.z), rank - part.x, triangle);
}

void list_row(ExactTriangle t, ivec3 low, ivec3 high, ivec2 row, uint triangle) {
    const ivec2 span = row_span(t, row);
    for (int x = max(span.x, low.x); x <= min(span.y, high.x); ++x) list_voxel(ivec3(x, row) - region_origin, triangle);
}

void main() {
    const uint thread = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * VOXEL_GROUP;
#if LARGE
    if (thread >= count * slice_count) return;
    const uint triangle = queued(0u, first + thread / slice_count);
#else
    if (thread >= count) return;
    const uint triangle = has_subset != 0 ? subset[first + thread] : first + thread;
#endif
    const uvec4 corners = surface_triangles[triangle].vertices_material;
    const ExactTriangle t = exact_triangle(surface_position(corners.x), surface_position(corners.y),
                                           surface_position(corners.z), voxel_shift);
    const ivec3 low = max(t.low, region_origin + ivec3(0, 0, part_slices.x));
    const ivec3 high = min(t.high, region_origin + ivec3(region_size.xy - 1, part_slices.y));
    const ivec3 size = high - low + 1;
    if (any(lessThan(size, ivec3(1)))) return;
    const uint row_count = uint(size.y) * uint(size.z);
#if LARGE
    const uint end = min(row_count, row_range.y);
    for (uint i = row_range.x + thread % slice_count; i < end; i += slice_count) {
#else
    if (float(size.x) * float(size.y) * float(size.z) > float(ATTRIBUTE_SMALL_BOX)) {
        enqueue(0u, triangle);
        return;
    }
    for (uint i = 0u; i < row_count; ++i) {
#endif
        const ivec2 row = low.yz + ivec2(i % uint(size.y), i / uint(size.y));
        list_row(t, low, high, row, triangle);
    }
}
