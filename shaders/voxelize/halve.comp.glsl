// One thread is two words of the coarser level, side by side. Each voxel is the OR of 2 x 2 x 2 voxels of the
// finer level, or of 2 x 2 x 1 if all slices are kept (Forest et al. 2009, section 2.3, Figure 4). The thread
// reads through a buffer texture, four words at a time if the rows allow it, because software drivers load
// from storage buffers lane by lane.
#include "interop/voxelize.h"
#include "common/thread.glsl"

layout(binding = TEXTURE_HALVE_FINE) uniform usamplerBuffer fine_bits;  // with WIDE four words per texel, else one
layout(std430, binding = SSBO_HALVE_COARSE) restrict writeonly buffer CoarseBits { uint coarse_bits[]; };

uniform ivec3 fine_size;
uniform ivec3 coarse_size;  // if its z is that of fine_size, all slices are kept

// Four words of a row of the finer level.
uvec4 fine_words(int row, int first) {
    const int words = (fine_size.x + 31) >> 5;
#if WIDE
    return texelFetch(fine_bits, (row * words + first) >> 2);
#else
    uvec4 four = uvec4(0u);
    for (int i = 0; i < 4; ++i) {
        if (first + i < words) four[i] = texelFetch(fine_bits, row * words + first + i).x;
    }
    return four;
#endif
}

// Bit i of the result is the OR of bits 2i and 2i + 1.
uvec4 or_of_pairs(uvec4 word) {
    word = (word | word >> 1) & 0x55555555u;
    word = (word | word >> 1) & 0x33333333u;
    word = (word | word >> 2) & 0x0F0F0F0Fu;
    word = (word | word >> 4) & 0x00FF00FFu;
    return (word | word >> 8) & 0x0000FFFFu;
}

void main() {
    const int coarse_words = (coarse_size.x + 31) >> 5;
    const int pairs = (coarse_words + 1) >> 1;
    const uint thread = thread_index();
    if (thread >= uint(pairs * coarse_size.y * coarse_size.z)) return;
    const int coarse_row = int(thread) / pairs;
    const int pair = int(thread) % pairs;
    const ivec2 step = ivec2(2, coarse_size.z == fine_size.z ? 1 : 2);
    const ivec2 low = step * ivec2(coarse_row % coarse_size.y, coarse_row / coarse_size.y);
    const ivec2 high = min(low + step - 1, fine_size.yz - 1);
    const uvec4 words = fine_words(low.y * fine_size.y + low.x, 4 * pair) |
                        fine_words(low.y * fine_size.y + high.x, 4 * pair) |
                        fine_words(high.y * fine_size.y + low.x, 4 * pair) |
                        fine_words(high.y * fine_size.y + high.x, 4 * pair);
    const uvec4 halves = or_of_pairs(words);
    const int place = coarse_row * coarse_words + 2 * pair;
    coarse_bits[place] = halves.x | halves.y << 16;
    if (2 * pair + 1 < coarse_words) coarse_bits[place + 1] = halves.z | halves.w << 16;
}
