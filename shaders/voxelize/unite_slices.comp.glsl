// Joins a target of one direction with the bits of the region (Forest et al. 2009, section 2.2, Figure 3).
//
// Along x, a channel of a texel is a word of a row: one thread is one texel. Along y and z, one thread takes 32 texels of
// a row, and turns the 32 x 32 bits of each channel: slices by columns become columns by slices.
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
uvec4 rows[32];

// Bit j of row i becomes bit i of row j, in all channels at once (Warren, Hacker's Delight, section 7-3).
void turn_rows() {
    uint mask = 0x0000FFFFu;
    for (int step = 16; step != 0; step >>= 1) {
        for (int row = 0; row < 32; row = (row + step + 1) & ~step) {
            const uvec4 swapped = ((rows[row] >> uint(step)) ^ rows[row + step]) & mask;
            rows[row + step] ^= swapped;
            rows[row] ^= swapped << uint(step);
        }
        mask ^= mask << uint(step >> 1);
    }
}

void unite_texels(int word, int other) {
    uvec4 any_bits = uvec4(0u);
    for (int i = 0; i < 32; ++i) {
        const ivec2 texel = ivec2(32 * word + i, other);
        rows[i] = texel.x < tile_size.x ? texelFetch(target_slices, ivec3(texel, layer), 0) : uvec4(0u);
        any_bits |= rows[i];
    }
    if (any_bits == uvec4(0u)) return;
    turn_rows();
    const int depth = axis == 1 ? tile_size.y : tile_size.z;
    for (int channel = 0; channel < 4; ++channel) {
        const int slice = first_slice + 32 * channel;
        const int last = min(depth - slice, 32);
        for (int i = 0; i < last; ++i) {
            const ivec3 place = axis == 1 ? ivec3(32 * word, slice + i, other) : ivec3(32 * word, other, slice + i);
            unite(place, rows[i][channel]);
        }
    }
}

#endif

void main() {
    const int thread = int(gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * VOXEL_GROUP);
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
