#pragma once

#include <algorithm>
#include <cstdint>

/// Bits of the words of a BitGrid's rows.
namespace cairn::voxelizer {

/// The lowest bits of a word; all if there are 32 or more.
[[nodiscard]] inline std::uint32_t low_bits(int count) {
    return count >= 32 ? ~0U : (1U << count) - 1U;
}

/// Sets the bits of a row from `first` up to, not including, `end`.
inline void set_bits(std::uint32_t* words, int first, int end) {
    while (first < end) {
        const int word = first / 32;
        const int stop = std::min(end, (word + 1) * 32);
        words[word] |= low_bits(stop - word * 32) & (~0U << (first % 32));
        first = stop;
    }
}

}  // namespace cairn::voxelizer
