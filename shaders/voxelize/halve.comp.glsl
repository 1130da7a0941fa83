// One thread is one word of the coarser level: the OR of 2 x 2 x 2 voxels of the finer one, or of 2 x 2 x 1 where all
// slices are kept (Forest et al. 2009, section 2.3, Figure 4).
#include "interop/bindings.h"
#include "interop/config.h"

layout(local_size_x = VOXEL_GROUP) in;

layout(std430, binding = SSBO_HALVE_FINE) restrict readonly buffer FineBits { uint fine_bits[]; };
layout(std430, binding = SSBO_HALVE_COARSE) restrict writeonly buffer CoarseBits { uint coarse_bits[]; };

uniform ivec3 fine_size;
uniform ivec3 coarse_size;  // of equal z: all slices are kept

uint fine_word(ivec3 place, int words_per_row) {
    if (place.x >= words_per_row || place.y >= fine_size.y || place.z >= fine_size.z) return 0u;
    return fine_bits[(place.z * fine_size.y + place.y) * words_per_row + place.x];
}

// Bit i of the result is the OR of bits 2i and 2i + 1.
uint or_of_pairs(uint word) {
    word = (word | word >> 1) & 0x55555555u;
    word = (word | word >> 1) & 0x33333333u;
    word = (word | word >> 2) & 0x0F0F0F0Fu;
    word = (word | word >> 4) & 0x00FF00FFu;
    return (word | word >> 8) & 0x0000FFFFu;
}

void main() {
    const int fine_words = (fine_size.x + 31) >> 5;
    const int coarse_words = (coarse_size.x + 31) >> 5;
    const uint thread = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * VOXEL_GROUP;
    if (thread >= uint(coarse_words * coarse_size.y * coarse_size.z)) return;
    const int word = int(thread);
    const ivec3 place = ivec3(word % coarse_words, word / coarse_words % coarse_size.y,
                              word / coarse_words / coarse_size.y);
    uint halves[2] = uint[2](0u, 0u);
    // One slice is its own half: then both steps agree.
    const int slices = coarse_size.z == fine_size.z ? 1 : 2;
    for (int corner = 0; corner < 4 * slices; ++corner) {
        const ivec3 offset = ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        halves[offset.x] |= fine_word(place * ivec3(2, 2, slices) + offset, fine_words);
    }
    coarse_bits[word] = or_of_pairs(halves[0]) | or_of_pairs(halves[1]) << 16;
}
