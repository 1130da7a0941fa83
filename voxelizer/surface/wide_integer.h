#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::voxelizer {

/// An integer of 128 bits, for exact predicates (GCC and Clang).
__extension__ using Int128 = __int128;

/// A vector of 128-bit integers, for which glm's vectors are not made.
struct Wide3 {
    Int128 x, y, z;
};

[[nodiscard]] inline Int128 floor_divide(Int128 numerator, Int128 positive_divisor) {
    const Int128 quotient = numerator / positive_divisor;
    return numerator % positive_divisor < 0 ? quotient - 1 : quotient;
}
[[nodiscard]] inline Int128 ceil_divide(Int128 numerator, Int128 positive_divisor) {
    return -floor_divide(-numerator, positive_divisor);
}

[[nodiscard]] inline Int128 dot(const Wide3& a, const Wide3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[nodiscard]] inline Wide3 cross(const Wide3& a, const Wide3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace cairn::voxelizer
