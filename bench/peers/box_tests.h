#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gl/handle.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/front_cells.h"
#include "shaders/interop/march.h"

namespace cairn::bench {

/// OpenGL's occlusion queries against the depths at which a picture's rays have become opaque: does a box
/// reach into what may still be seen (Crassin 2007, section 3.6.1)?
///
/// Boxes are drawn a 64th of a pixel larger than they are. Rasterizers round corners to 256ths, and a ray
/// that only just comes through a box must not be missed.
class BoxTests {
public:
    /// Rays that start at the view's eye.
    BoxTests(const interop::MarchView& view, const gl::ShaderSource& shaders);

    /// @param inverse_depths  1 / depth along the view in voxels, of each pixel, row 0 at the top; 0 where
    /// rays get through. Tests that begin() has started go by the depths before.
    void set_depths(std::span<const float> inverse_depths);

    /// Starts a test of each box, and does not wait for any. Boxes in voxels of the finest level.
    /// @return  how many it took: boxes around the eye are visible in any case.
    std::size_t begin(std::span<const renderer::Box> boxes);
    /// Of the tests that were started last, waiting for them where need be.
    [[nodiscard]] std::vector<bool> visible() const;

private:
    [[nodiscard]] renderer::Box around(const renderer::Box& box) const;

    glm::dvec3 eye_;
    glm::vec3 forward_;
    glm::vec3 across_;
    glm::vec3 down_;
    glm::ivec2 size_;
    double pixel_ = 0.0;  // width at distance 1
    gl::Program program_;
    gl::TextureHandle depths_;
    gl::FramebufferHandle target_;
    gl::VertexArrayHandle no_attributes_;
    std::vector<gl::QueryHandle> queries_;  // of the boxes begun last; none where the eye is inside
};

}  // namespace cairn::bench
