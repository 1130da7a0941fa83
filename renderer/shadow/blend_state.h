#pragma once

#include <array>

#include <glad/gl.h>

namespace cairn::renderer {

/// Puts back, when it goes out of scope, the blend equations and factors of the first two targets: what
/// gl::DrawStateGuard leaves alone, because blending that is off needs none.
class BlendStateGuard {
public:
    BlendStateGuard() {
        for (GLuint target = 0; target < targets; ++target) {
            for (std::size_t i = 0; i < names.size(); ++i)
                glGetIntegeri_v(names[i], target, &saved_[target][i]);
        }
    }
    ~BlendStateGuard() {
        for (GLuint target = 0; target < targets; ++target) {
            const auto& [color, alpha, from, to, alpha_from, alpha_to] = saved_[target];
            glBlendEquationSeparatei(target, GLenum(color), GLenum(alpha));
            glBlendFuncSeparatei(target, GLenum(from), GLenum(to), GLenum(alpha_from), GLenum(alpha_to));
        }
    }
    BlendStateGuard(const BlendStateGuard&) = delete;
    BlendStateGuard& operator=(const BlendStateGuard&) = delete;
    BlendStateGuard(BlendStateGuard&&) = delete;
    BlendStateGuard& operator=(BlendStateGuard&&) = delete;

private:
    static constexpr GLuint targets = 2;
    static constexpr std::array<GLenum, 6> names = {GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA,
                                                    GL_BLEND_SRC_RGB,      GL_BLEND_DST_RGB,
                                                    GL_BLEND_SRC_ALPHA,    GL_BLEND_DST_ALPHA};
    std::array<std::array<GLint, 6>, targets> saved_{};
};

}  // namespace cairn::renderer
