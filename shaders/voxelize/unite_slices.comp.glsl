// Joins a target of one direction with the bits of the region (Forest et al. 2009, section 2.2, Figure 3).
//
// One thread is one texel. Along x, a channel of it is a word of a row. Along y and z, 32 threads turn the 32 x 32 bits of
// each channel of 32 texels in a row.
// defines: ALONG_X=0
// defines: ALONG_X=1
#include "voxelize/bits.glsl"
#include "interop/config.h"

layout(local_size_x = VOXEL_GROUP) in;

layout(binding = TEXTURE_SLICES) uniform usampler2DArray target_slices;
uniform ivec3 tile_place;  // voxels from the region's low corner; x is a multiple of 32
uniform ivec3 tile_size;
uniform int axis;  // 1 or 2, where not along x
uniform int layer;
uniform int tall;  // the layer of x has y downwards, not z
uniform int first_slice;

void unite(ivec3 place, uint bits) {
    const int words_per_row = (region_size.x + 31) >> 5;
    const ivec3 v = tile_place + place;
    // No other thread of the dispatch has this word.
    if (bits != 0u) voxel_bits[(v.z * region_size.y + v.y) * words_per_row + (v.x >> 5)] |= bits;
}

#if ALONG_X
void unite_texel(ivec2 texel) {
    const uvec4 bits = texelFetch(target_slices, ivec3(texel, layer), 0);
    for (int channel = 0; channel < 4; ++channel) {
        const int x = first_slice + 32 * channel;
        const int left = clamp(tile_size.x - x, 0, 32);
        const uint inside = left == 32 ? 0xFFFFFFFFu : (1u << uint(left)) - 1u;
        if (left > 0) unite(tall != 0 ? ivec3(x, texel.yx) : ivec3(x, texel), bits[channel] & inside);
    }
}

#else
#define ROWS (VOXEL_GROUP / 32)
shared uvec4 texels_of_row[VOXEL_GROUP];
shared uint row_has_bits[ROWS];

// Thread i of a row of 32 texels reads texel i, and writes the words of slices i of the four channels: the bits of 32
// columns of voxels become words of 32 slices. All threads of a group come here.
void unite_texels(int row, int word, int other, bool inside) {
    const int i = int(gl_LocalInvocationID.x) & 31;
    if (i == 0) row_has_bits[row] = 0u;
    barrier();
    const ivec2 texel = ivec2(32 * word + i, other);
    const uvec4 own = inside && texel.x < tile_size.x ? texelFetch(target_slices, ivec3(texel, layer), 0) : uvec4(0u);
    texels_of_row[gl_LocalInvocationID.x] = own;
    if (own != uvec4(0u)) atomicOr(row_has_bits[row], 1u);
    barrier();
    if (row_has_bits[row] == 0u) return;
    uvec4 columns = uvec4(0u);
    for (int column = 0; column < 32; ++column) {
        columns |= (texels_of_row[32 * row + column] >> uint(i) & 1u) << uint(column);
    }
    const int depth = axis == 1 ? tile_size.y : tile_size.z;
    for (int channel = 0; channel < 4; ++channel) {
        const int slice = first_slice + 32 * channel + i;
        const ivec3 place = axis == 1 ? ivec3(32 * word, slice, other) : ivec3(32 * word, other, slice);
        if (slice < depth) unite(place, columns[channel]);
    }
}
#endif

void main() {
    const int group = int(gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x);
#if ALONG_X
    const int thread = group * VOXEL_GROUP + int(gl_LocalInvocationID.x);
    const int across = tall != 0 ? tile_size.z : tile_size.y;
    const int down = tall != 0 ? tile_size.y : tile_size.z;
    if (thread < across * down) unite_texel(ivec2(thread % across, thread / across));
#else
    const int across = (tile_size.x + 31) >> 5;
    const int down = axis == 2 ? tile_size.y : tile_size.z;
    const int row = int(gl_LocalInvocationID.x) >> 5;
    const int place = group * ROWS + row;
    unite_texels(row, place % across, place / across, place < across * down);
#endif
}
