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

/// OpenGL's occlusion queries against the depths at which a picture's rays have become opaque: is a
/// part of a box in front of them (Crassin 2007, section 3.6.1)?
///
/// Boxes are drawn larger by a 64th of a pixel, because rasterizers round corners to 256ths, and a ray that
/// only just goes through a box must not be missed.
class BoxTests {
public:
    /// @param view  a view whose rays start at its eye.
    BoxTests(const interop::MarchView& view, const gl::ShaderSource& shaders);

    /// @param inverse_depths  1 / depth along the view in voxels, per pixel, row 0 at the top; 0 where the
    /// ray has not become opaque. Tests that begin() has started already use the depths before.
    void set_depths(std::span<const float> inverse_depths);

    /// Starts a test of each box, and waits for none. Boxes are in voxels of the finest level.
    /// @return  the number of tests; boxes around the eye need none, because they are visible in any case.
    std::size_t begin(std::span<const renderer::Box> boxes);
    /// The results of the tests that were started last, per box. Waits for them if need be.
    [[nodiscard]] std::vector<bool> visible() const;

private:
    [[nodiscard]] renderer::Box around(const renderer::Box& box) const;

    glm::dvec3 eye_;
    glm::vec3 forward_;
    glm::vec3 across_;
    glm::vec3 down_;
    glm::ivec2 size_;
    double pixel_ = 0.0;  // width of a pixel at distance 1
    gl::Program program_;
    gl::TextureHandle depths_;
    gl::FramebufferHandle target_;
    gl::VertexArrayHandle no_attributes_;
    // One per box of the last begin(); empty if the eye is inside.
    std::vector<gl::QueryHandle> queries_;
};

}  // namespace cairn::bench
