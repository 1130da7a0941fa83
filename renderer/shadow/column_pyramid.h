#pragma once

#include <cstddef>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "gl/shader_source.h"

namespace cairn::renderer {

/// The xy-reduced pyramid of Forest et al. 2009, section 2.3, on the GPU: level l holds (resolution / 2^l)^2
/// columns of one bit per voxel. All columns have full resolution along their axis; each is the OR of four
/// finer columns. A column runs along x, as the words of a BitGrid do (the paper's z is our x).
///
///     first texel of a level: COLUMN_TEXEL_BITS bits each; columns y + z * (resolution >> level)
///
/// Needs the context that was current at its construction.
class ColumnPyramid {
public:
    /// @param resolution  voxels per side: a power of two, 8 to 2048.
    /// @throws Error  Fault::usage for another resolution; Fault::memory if the pyramid does not fit.
    explicit ColumnPyramid(int resolution, const gl::ShaderSource& shaders = {});

    /// Size, in voxels, of the grid that level 0 is built from. It has whole texels along x, so at least
    /// COLUMN_TEXEL_BITS voxels; voxels past the resolution are ignored.
    [[nodiscard]] glm::ivec3 grid_size() const;

    /// Builds all levels.
    /// @param bits  BitGrid::words of grid_size() voxels.
    void build(const gl::Buffer& bits);

    /// Macros for shaders that include shadow/columns.glsl: COLUMN_LEVELS.
    [[nodiscard]] gl::Defines defines() const;
    /// Binds the texture TEXTURE_COLUMNS for shaders that include shadow/columns.glsl.
    void bind_for_reading() const;

    [[nodiscard]] int resolution() const { return 1 << levels_; }
    [[nodiscard]] std::size_t size_bytes() const { return texels_.size_bytes(); }
    [[nodiscard]] const gl::Buffer& texels() const { return texels_; }
    /// Time of the last build(), by the wall clock from an idle driver to an idle driver.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }

private:
    int levels_;  ///< log2 of the resolution
    gl::Program halve_;
    gl::Buffer texels_;
    gl::TextureHandle texture_;
    double last_milliseconds_ = 0.0;
};

}  // namespace cairn::renderer
