#pragma once

#include <vector>

#include <glad/gl.h>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "voxelizer/surface/surface.h"

namespace cairn::bench {

/// Draws all triangles along x, y and z, orthographically, without writing anything: depth test, culling and
/// colour writes are off, and the framebuffer has one attachment of eight bits. It finds no voxels; its time
/// is a lower bound for any method by rasterization (Forest et al. 2009, Table 1).
class ThreeDirections {
public:
    /// @throws Error (Fault::context) if the driver does not take the framebuffer.
    ThreeDirections(const voxelizer::Surface& surface, int resolution);

    /// Draws once. @return milliseconds from an idle driver to an idle driver.
    [[nodiscard]] double draw() const;

private:
    struct Draw {
        gl::Buffer positions;
        gl::Buffer indices;
        GLsizei count;
    };

    int resolution_;
    std::vector<Draw> draws_;
    gl::TextureHandle target_;
    gl::FramebufferHandle framebuffer_;
    gl::VertexArrayHandle vertices_;
    gl::Program program_;
};

}  // namespace cairn::bench
