#pragma once

#include <array>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "voxelizer/bit_grid.h"

namespace cairn::voxelizer {

/// Computes the levels of a bitmask pyramid on the GPU, each the OR of the finer one (Forest et al. 2009,
/// section 2.3).
class PyramidBuilder {
public:
    explicit PyramidBuilder(const gl::ShaderSource& shaders);

    /// @param bits  BitGrid::words of the finest level, `size` voxels
    [[nodiscard]] BitmaskPyramid build(const gl::Buffer& bits, const glm::ivec3& size);

    /// Computing the coarser levels of the last `build()`, no read-back, from an idle driver to an idle
    /// driver.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }

private:
    gl::Program halve_;
    double last_milliseconds_ = 0.0;
};

/// Bytes of BitGrid::words.
[[nodiscard]] std::size_t bit_bytes(const glm::ivec3& size);

[[nodiscard]] BitGrid read_bits(const gl::Buffer& bits, const glm::ivec3& size);

}  // namespace cairn::voxelizer
