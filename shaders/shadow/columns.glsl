// The xy-reduced pyramid of Forest et al. 2009, section 2.3: level l has (side / 2^l)^2 columns, each with
// all its bits. A column runs along x, as the words of a BitGrid do; the z of Forest et al. is x here, and
// their x and y are y and z.
// Needs the define COLUMN_LEVELS: log2 of the side.
#include "interop/columns.h"

#define COLUMN_SIDE (1 << COLUMN_LEVELS)
#define COLUMN_TEXELS ((COLUMN_SIDE + COLUMN_TEXEL_BITS - 1) / COLUMN_TEXEL_BITS)  // texels per column

layout(binding = TEXTURE_COLUMNS) uniform usamplerBuffer columns;

// First texel of the column at (y, z) of a level. The finer levels have 4^COLUMN_LEVELS + ... columns. Such a
// sum of powers of 4 is a third of the difference of two powers of 4: the number whose bits are every other
// bit of it.
int column_at(int level, ivec2 place) {
    const int below = (1 << (2 * COLUMN_LEVELS)) - (1 << (2 * (COLUMN_LEVELS - level)));
    return (4 * (below & 0x55555555) + (place.y << (COLUMN_LEVELS - level)) + place.x) * COLUMN_TEXELS;
}

// A mask of the bits `first` to `last` of a texel; both may lie outside the texel.
uvec4 bits_between(int first, int last) {
    const ivec4 word_first = ivec4(0, 32, 64, 96);
    const ivec4 low = clamp(first - word_first, 0, 32);
    const ivec4 high = clamp(last + 1 - word_first, 0, 32);  // one past the last bit
    const uvec4 from = mix(uvec4(0xFFFFFFFFu) << uvec4(low & 31), uvec4(0u), equal(low, ivec4(32)));
    const uvec4 below = mix((uvec4(1u) << uvec4(high & 31)) - 1u, uvec4(0xFFFFFFFFu), equal(high, ivec4(32)));
    return from & below;
}

int lowest_bit(uvec4 bits) {
    const ivec4 at = findLSB(bits);
    return bits.x != 0u ? at.x : bits.y != 0u ? 32 + at.y : bits.z != 0u ? 64 + at.z : 96 + at.w;
}
int highest_bit(uvec4 bits) {
    const ivec4 at = findMSB(bits);
    return bits.w != 0u ? 96 + at.w : bits.z != 0u ? 64 + at.z : bits.y != 0u ? 32 + at.y : at.x;
}

// The first occupied voxel of a column on the way from x = `from` to x = `to`, in either direction; -1 if
// there is none.
int first_occupied(int column, int from, int to, inout int turns) {
    const int way = from <= to ? 1 : -1;
    const int low = min(from, to);
    const int high = max(from, to);
    const int last = to / COLUMN_TEXEL_BITS;
    for (int texel = from / COLUMN_TEXEL_BITS;; texel += way) {
        ++turns;
        const int first_bit = texel * COLUMN_TEXEL_BITS;
        const uvec4 bits = texelFetch(columns, column + texel) & bits_between(low - first_bit, high - first_bit);
        if (bits != uvec4(0u)) return first_bit + (way > 0 ? lowest_bit(bits) : highest_bit(bits));
        if (texel == last) return -1;
    }
}
