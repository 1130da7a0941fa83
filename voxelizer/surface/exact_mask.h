#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "shaders/interop/surface.h"

namespace cairn::voxelizer {

/// A triangle that an alpha mask cuts: the part of it inside a closed voxel is surface where it touches a
/// closed texel square whose alpha passes the cutoff.
///
/// This is the definition, for the few triangles that shaders leave to the CPU and for the reference; the
/// shaders' own way is shaders/voxelize/alpha_mask.glsl. A point of the triangle is its three weights. Sides
/// of the triangle, of the voxel and of a texel, and the cutoff, are each a line that is linear and
/// homogeneous in the weights, with whole coefficients. They share a point exactly when one of the crossings
/// of two of them lies on the right side of all.
class ExactMask {
public:
    /// @param positions  lattice units, within +-2^40
    /// @param texels     of all images; must outlive this
    ExactMask(const std::array<glm::i64vec3, 3>& positions, const std::array<glm::vec2, 3>& texcoords,
              const std::array<std::uint32_t, 3>& colors, const interop::SurfaceMaterial& material,
              std::span<const std::uint32_t> texels);

    /// @param low   corner of the voxel, lattice units
    /// @param side  of the voxel
    [[nodiscard]] bool touches(const glm::i64vec3& low, std::int64_t side) const;

private:
    [[nodiscard]] std::int64_t alpha_at(std::int64_t column, std::int64_t row) const;

    std::array<glm::i64vec3, 3> positions_;
    std::array<glm::i64vec2, 3> texel_coordinates_;  ///< whole units of a texel's `texel_side_`-th part
    std::int64_t texel_side_ = 1;
    glm::i64vec2 period_{0};  ///< whole textures taken off the coordinates
    std::array<std::int64_t, 3> alphas_;
    interop::SurfaceMaterial material_;
    std::span<const std::uint32_t> texels_;
};

}  // namespace cairn::voxelizer
