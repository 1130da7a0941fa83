#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::reference {

/// Whether a closed triangle meets a closed box: exact for coordinates within +-2^40. A triangle may be a
/// segment or a point.
///
/// Tests all 13 axes of Akenine-Möller 2001, each by comparing the two intervals in 128-bit integers.
[[nodiscard]] bool triangle_meets_box(const std::array<glm::i64vec3, 3>& triangle, const glm::i64vec3& low,
                                      const glm::i64vec3& high);

}  // namespace cairn::reference
