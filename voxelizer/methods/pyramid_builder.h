#pragma once

#include <compare>
#include <vector>

#include "gl/buffer.h"
#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "voxelizer/bit_grid.h"

namespace cairn::voxelizer {

/// Computes the levels of a bitmask pyramid on the GPU, each the OR of the finer one (Forest et al. 2009,
/// section 2.3).
class PyramidBuilder {
public:
    explicit PyramidBuilder(const gl::ShaderSource& shaders);

    /// @param bits  BitGrid::words of the finest level, `size` voxels
    [[nodiscard]] BitmaskPyramid build(const gl::Buffer& bits, const glm::ivec3& size,
                                       Reduction reduction = Reduction::xyz);

    /// Time of all coarser levels in the last build(), without their read-back, by the wall clock.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }

private:
    /// A level on the GPU, and the buffer texture through which the next one is computed from it.
    struct Level {
        glm::ivec3 size{0};
        gl::Buffer bits;
        gl::TextureHandle texture;
    };
    void prepare(const glm::ivec3& size, Reduction reduction);
    void halve(const gl::TextureHandle& fine, const glm::ivec3& fine_size, const Level& coarse);

    /// The key of the programs that halve a level.
    struct HalveVariant {
        bool is_wide = false;  ///< rows are read four words at a time
        [[nodiscard]] auto operator<=>(const HalveVariant&) const = default;
    };
    gl::ProgramFamily<HalveVariant> halve_;
    gl::TextureHandle finest_;   ///< view of the buffer that the last build() was given
    std::vector<Level> levels_;  ///< kept for the next pyramid of the same size and reduction
    glm::ivec3 finest_size_{0};
    Reduction reduction_ = Reduction::xyz;
    double last_milliseconds_ = 0.0;
};

/// Bytes of BitGrid::words of a grid of this size.
[[nodiscard]] std::size_t bit_bytes(const glm::ivec3& size);

[[nodiscard]] BitGrid read_bits(const gl::Buffer& bits, const glm::ivec3& size);

}  // namespace cairn::voxelizer
