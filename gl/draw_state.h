#pragma once

#include <array>

#include <glad/gl.h>

namespace cairn::gl {

/// Sets the state that decides whether and how a fragment reaches its target to OpenGL's defaults, and
/// restores the caller's state when the guard goes out of scope: render passes deep in a library neither
/// inherit state nor leave any behind.
///
/// The guard covers tests, blending (of the first two draw buffers), logic operation, colour mask, culling,
/// which side is the front, polygon mode, widths of lines and points, viewport, draw framebuffer, vertex
/// array, and texture and sampler of unit 0.
class DrawStateGuard {
public:
    DrawStateGuard();
    ~DrawStateGuard();
    DrawStateGuard(const DrawStateGuard&) = delete;
    DrawStateGuard& operator=(const DrawStateGuard&) = delete;
    DrawStateGuard(DrawStateGuard&&) = delete;
    DrawStateGuard& operator=(DrawStateGuard&&) = delete;

private:
    static constexpr std::array<GLenum, 12> switches = {
        GL_BLEND,       GL_COLOR_LOGIC_OP, GL_CULL_FACE,          GL_DEPTH_TEST,
        GL_LINE_SMOOTH, GL_POLYGON_SMOOTH, GL_PROGRAM_POINT_SIZE, GL_RASTERIZER_DISCARD,
        GL_SAMPLE_MASK, GL_SCISSOR_TEST,   GL_STENCIL_TEST,       GL_PRIMITIVE_RESTART};

    std::array<GLboolean, switches.size()> enabled_{};
    struct Blending {
        GLint equation_rgb, equation_alpha, source_rgb, source_alpha, destination_rgb, destination_alpha;
    };

    GLint logic_op_ = 0;
    GLint front_face_ = 0;
    std::array<Blending, 2> blending_{};
    std::array<GLboolean, 4> color_mask_{};
    GLint polygon_mode_ = 0;
    GLfloat line_width_ = 1.0F;
    GLfloat point_size_ = 1.0F;
    std::array<GLfloat, 4> viewport_{};
    GLint framebuffer_ = 0;
    GLint vertex_array_ = 0;
    GLint active_texture_ = 0;
    GLint texture_2d_array_ = 0;
    GLint sampler_ = 0;
};

}  // namespace cairn::gl
