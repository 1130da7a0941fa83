#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "app/viewer/refinement.h"
#include "gl/handle.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// Draws pictures over the whole window. Pictures are sRGB-encoded already, and a window's framebuffer takes
/// bytes as they are, because GL_FRAMEBUFFER_SRGB is off by default.
class Canvas {
public:
    /// @param revision  number of the image; it is sent to the GPU only if the number has changed.
    void draw(const optics::Image& image, std::uint64_t revision, const glm::ivec2& window);
    /// Draws only the rows that have been rendered.
    void draw(const Refinement& growing, std::uint64_t revision, const glm::ivec2& window);

private:
    struct Sheet {
        gl::TextureHandle texture;
        gl::FramebufferHandle framebuffer;
        glm::ivec2 size{0};
        std::uint64_t revision = 0;  // revision of the image in the texture; 0: no image
        void hold(const optics::Image& image, std::uint64_t new_revision);
        void draw(const renderer::Rows& rows, const glm::ivec2& window) const;
    };
    Sheet base_;
    Sheet growing_;
};

}  // namespace cairn::app
