// Joins a target of one direction with the bits of the region (Forest et al. 2009, section 2.2, Figure 3).
//
// For the direction x, a channel of a texel is a word of a row, and one thread is one texel. For y and z, one
// thread is 32 texels of a row, whose bits in one slice are a word.
#include "voxelize/bits.glsl"
#include "interop/voxelize.h"
#include "common/thread.glsl"

layout(binding = TEXTURE_SLICES) uniform usampler2DArray target_slices;
// Low corner, in voxels from the region's low corner; x is a multiple of 32.
uniform ivec3 tile_place;
uniform ivec3 tile_size;
uniform int axis;  // direction of the target, 1 or 2, if not ALONG_X
uniform int layer;
uniform int tall;  // 1: the layer of x has y downwards, not z
uniform int first_slice;

void unite(ivec3 place, uint bits) {
    const int words_per_row = (region_size.x + 31) >> 5;
    const ivec3 v = tile_place + place;
    // No other thread of the dispatch writes this word.
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
uvec4 column_bits(int word, int other, int column) {
    const ivec2 texel = ivec2(32 * word + column, other);
    return texel.x < tile_size.x ? texelFetch(target_slices, ivec3(texel, layer), 0) : uvec4(0u);
}

// A surface meets few of the slices in a row. So it is cheaper to read the row again for each slice than to
// hold 32 texels in private memory, whose accesses drivers unroll.
void unite_texels(int word, int other) {
    uvec4 met = uvec4(0u);
    for (int column = 0; column < 32; ++column) met |= column_bits(word, other, column);
    const int depth = (axis == 1 ? tile_size.y : tile_size.z) - first_slice;
    while (met != uvec4(0u)) {
        const ivec4 first = findLSB(met);
        // Bits of slices past the end of the tile do not count.
        const bvec4 inside = lessThan(first + ivec4(0, 32, 64, 96), ivec4(depth));
        met &= met - min(met, uvec4(1u));
        uvec4 bits = uvec4(0u);
        for (int column = 0; column < 32; ++column) {
            bits |= (column_bits(word, other, column) >> uvec4(first & 31) & 1u) << uint(column);
        }
        for (int channel = 0; channel < 4; ++channel) {
            const int slice = first_slice + 32 * channel + first[channel];
            const ivec3 place = axis == 1 ? ivec3(32 * word, slice, other) : ivec3(32 * word, other, slice);
            if (first[channel] >= 0 && inside[channel]) unite(place, bits[channel]);
        }
    }
}
#endif

void main() {
    const int thread = int(thread_index());
#if ALONG_X
    const int across = tall != 0 ? tile_size.z : tile_size.y;
    const int down = tall != 0 ? tile_size.y : tile_size.z;
#else
    const int across = (tile_size.x + 31) >> 5;
    const int down = axis == 2 ? tile_size.y : tile_size.z;
#endif
    if (thread >= across * down) return;
#if ALONG_X
    unite_texel(ivec2(thread % across, thread / across));
#else
    unite_texels(thread % across, thread / across);
#endif
}
