#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "shaders/interop/surface.h"

namespace cairn::voxelizer {

/// A triangle that an alpha mask cuts: its part inside a closed voxel is surface if the part touches a closed
/// texel square whose alpha passes the cutoff.
///
/// This is the definition, for the few triangles that shaders leave to the CPU and for the reference; the
/// shaders compute the same by shaders/voxelize/alpha_mask.glsl. A point of the triangle is given by its
/// three weights. The sides of the triangle, of the voxel and of a texel, and the cutoff, are lines that are
/// linear and homogeneous in the weights, with whole coefficients. Triangle, voxel and texel share a point
/// that passes the cutoff exactly if one of the crossings of two of these lines lies on the right side of all
/// lines.
class ExactMask {
public:
    /// @param positions  lattice units, within +-2^40
    /// @param alphas     of the vertices, 65535 = 1
    /// @param texels     texels of all images; must outlive this object
    ExactMask(const std::array<glm::i64vec3, 3>& positions, const std::array<glm::vec2, 3>& texcoords,
              const std::array<std::uint16_t, 3>& alphas, const interop::SurfaceMaterial& material,
              std::span<const std::uint32_t> texels);

    /// Whether the triangle's part inside a voxel is surface.
    /// @param low   low corner of the voxel, lattice units
    /// @param side  side of the voxel, lattice units
    [[nodiscard]] bool touches(const glm::i64vec3& low, std::int64_t side) const;

private:
    [[nodiscard]] std::int64_t alpha_at(std::int64_t column, std::int64_t row) const;

    std::array<glm::i64vec3, 3> positions_;
    std::array<glm::i64vec2, 3> texel_coordinates_;  ///< in units of 1 / texel_side_ of a texel
    std::int64_t texel_side_ = 1;
    glm::i64vec2 period_{0};  ///< whole textures subtracted from the coordinates
    std::array<std::int64_t, 3> alphas_;
    interop::SurfaceMaterial material_;
    std::span<const std::uint32_t> texels_;
};

}  // namespace cairn::voxelizer
