#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "gl/buffer.h"
#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "renderer/shadow/column_mask.h"
#include "renderer/shadow/column_pyramid.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// What is seen at the pixels of some rows (MeshSurface of renderer/mesh/mesh_raster.h).
struct ColumnReceivers {
    int first_row = 0;  ///< of the picture, in the textures
    GLuint nearest = 0;
    GLuint surface = 0;
    /// In sides of a voxel: voxels whose centres lie lower over a receiver's plane are part of its surface
    /// and cast no shadow on it.
    float self_shadow_height = 0.0F;
};

/// What tells the programs of shadow rays through a pyramid apart, beside its size.
struct ColumnVariant {
    ColumnMask mask = ColumnMask::adaptive;
    bool is_soft = false;  ///< rays go to samples of the light
    [[nodiscard]] auto operator<=>(const ColumnVariant&) const = default;
};
[[nodiscard]] gl::Defines defines(const ColumnVariant& variant);

/// Shadow rays from rasterized receivers through a pyramid of columns. Needs the context that was current at
/// its construction.
class ColumnShadows {
public:
    /// @param pyramid  its resolution counts.
    ColumnShadows(const ColumnPyramid& pyramid, ColumnMask mask, const gl::ShaderSource& shaders = {});

    /// Lights the band of a view that is told in the pyramid's voxels.
    /// @return  a word a pixel: sRGB-encoded RGBA, or with SHOW_LIGHT the bits of a float.
    [[nodiscard]] std::vector<std::uint32_t> light(const interop::MarchView& view,
                                                   const ColumnPyramid& pyramid,
                                                   const ColumnReceivers& receivers);

    /// Of the last light(), by the wall clock, without reading the pixels back.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }
    [[nodiscard]] int last_passes() const { return last_passes_; }

private:
    ColumnMask mask_;
    gl::ProgramFamily<ColumnVariant> programs_;
    gl::Buffer view_, image_, sums_, counts_;
    double last_milliseconds_ = 0.0;
    int last_passes_ = 0;
};

}  // namespace cairn::renderer
