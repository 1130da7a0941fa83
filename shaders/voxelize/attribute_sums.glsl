// The sums of an occupied voxel: whole numbers of 64 bits, so that the order of threads does not affect them.
// A sum has two words, the low word first; negative sums are in two's complement.
#include "interop/voxelize.h"

#define SUM_WEIGHT 0  // area, in faces of the voxel
#define SUM_COLOR 2
#define SUM_NORMAL 8

layout(std430, binding = SSBO_ATTRIBUTE_SUMS) restrict buffer AttributeSums { uint sums[]; };

// Adds a value, |value| < 2^20, to the sum at word `place`. Every step is exact but the last floor.
void add_to_sum(uint place, float value) {
    const float magnitude = abs(value) * ATTRIBUTE_HIGH_UNIT;
    const float whole = floor(magnitude);
    const float upper = (magnitude - whole) * 65536.0;
    const float lower = (upper - floor(upper)) * 65536.0;
    uint high = uint(whole);
    uint low = uint(upper) << 16 | uint(lower);
    if (value < 0.0) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    const uint before = atomicAdd(sums[place], low);
    high += before + low < low ? 1u : 0u;
    if (high != 0u) atomicAdd(sums[place + 1u], high);
}

void add_to_sums(uint place, vec3 values) {
    add_to_sum(place, values.x);
    add_to_sum(place + 2u, values.y);
    add_to_sum(place + 4u, values.z);
}
