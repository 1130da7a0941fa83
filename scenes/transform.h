#pragma once

#include <glm/glm.hpp>

namespace cairn::scenes {

/// An affine matrix times a point. The order of the operations is part of the contract, because
/// shaders/voxelize/deform.comp.glsl follows it to the same bits: (x + y) + (z + translation), nothing fused.
[[nodiscard]] inline glm::dvec3 transform_point(const glm::dmat4& matrix, const glm::dvec3& point) {
    return (glm::dvec3(matrix[0]) * point.x + glm::dvec3(matrix[1]) * point.y) +
           (glm::dvec3(matrix[2]) * point.z + glm::dvec3(matrix[3]));
}

}  // namespace cairn::scenes
