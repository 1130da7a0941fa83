#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "gl/buffer.h"
#include "gl/program_family.h"
#include "gl/shader_source.h"
#include "renderer/shadow/column_pyramid.h"
#include "renderer/shadow/shadow_base.h"
#include "shaders/interop/march.h"

namespace cairn::renderer {

/// The rasterized surface that is seen at the pixels of some rows (MeshSurface of
/// renderer/mesh/mesh_raster.h).
struct ColumnReceivers {
    int first_row = 0;   ///< the picture's row that is row 0 of the textures
    GLuint nearest = 0;  ///< MeshSurface::nearest
    GLuint surface = 0;  ///< MeshSurface::surface
    /// Voxels whose centres are at most this far above a receiver's plane, in voxel sides, stand for the
    /// receiver itself, and cast no shadow on it.
    float self_shadow_height = 0.0F;
};

/// What distinguishes the programs of shadow rays through pyramids of one size.
struct ColumnVariant {
    ColumnMask mask = ColumnMask::adaptive;
    bool is_soft = false;  ///< shadow rays go to samples of the light
    [[nodiscard]] auto operator<=>(const ColumnVariant&) const = default;
};
[[nodiscard]] gl::Defines defines(const ColumnVariant& variant);

/// Shadow rays from rasterized receivers through a pyramid of columns. Needs the context that was current at
/// its construction.
class ColumnShadows {
public:
    /// @param pyramid  only its resolution is read.
    ColumnShadows(const ColumnPyramid& pyramid, ColumnMask mask, const gl::ShaderSource& shaders = {});

    /// Lights the band of a view.
    /// @param view  in units of the pyramid's voxels.
    /// @return  one word per pixel: sRGB-encoded RGBA, or with SHOW_LIGHT the bits of a float.
    [[nodiscard]] std::vector<std::uint32_t> light(const interop::MarchView& view,
                                                   const ColumnPyramid& pyramid,
                                                   const ColumnReceivers& receivers);

    /// Time of the last light(), by the wall clock, without reading the pixels back.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }
    /// Passes of the last light().
    [[nodiscard]] int last_passes() const { return last_passes_; }

private:
    ColumnMask mask_;
    gl::ProgramFamily<ColumnVariant> programs_;
    gl::Buffer view_, image_, sums_, counts_;
    double last_milliseconds_ = 0.0;
    int last_passes_ = 0;
};

}  // namespace cairn::renderer
