// The region whose voxels are marked, with one bit per voxel as in voxelizer/bit_grid.h.
#include "interop/voxelize.h"

layout(std430, binding = SSBO_VOXEL_BITS) restrict buffer VoxelBits { uint voxel_bits[]; };

uniform ivec3 region_origin;
uniform ivec3 region_size;

// Marks the voxels of a row from span.x to span.y. The row must lie in the region; the span is cut to it.
void mark_span(ivec2 row, ivec2 span) {
    const int first = max(span.x - region_origin.x, 0);
    const int last = min(span.y - region_origin.x, region_size.x - 1);
    if (first > last) return;
    const ivec2 place = row - region_origin.yz;
    const int row_word = (place.y * region_size.y + place.x) * ((region_size.x + 31) >> 5);
    const int first_word = first >> 5;
    const int last_word = last >> 5;
    const uint low_bits = 0xFFFFFFFFu << uint(first & 31);
    const uint high_bits = 0xFFFFFFFFu >> uint(31 - (last & 31));
    atomicOr(voxel_bits[row_word + first_word], first_word == last_word ? low_bits & high_bits : low_bits);
    for (int word = first_word + 1; word <= last_word; ++word) {
        atomicOr(voxel_bits[row_word + word], word == last_word ? high_bits : 0xFFFFFFFFu);
    }
}

// Whether a voxel of the region is marked already. It may miss a mark that another thread sets at the same
// time.
bool is_marked(ivec3 voxel) {
    const ivec3 place = voxel - region_origin;
    const int row_word = (place.z * region_size.y + place.y) * ((region_size.x + 31) >> 5);
    return (voxel_bits[row_word + (place.x >> 5)] >> uint(place.x & 31) & 1u) != 0u;
}
