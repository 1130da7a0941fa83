#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "app/viewer/refinement.h"
#include "gl/handle.h"
#include "renderer/renderer.h"

namespace cairn::app {

/// Puts pictures on the whole of the window. They are sRGB-encoded already, and so is a window's framebuffer
/// as long as GL_FRAMEBUFFER_SRGB is off, as it is by default: bytes are copied as they are.
class Canvas {
public:
    void draw(const optics::Image& image, std::uint64_t revision, const glm::ivec2& window);
    /// Only the rows that have been rendered.
    void draw(const Refinement& growing, std::uint64_t revision, const glm::ivec2& window);

private:
    struct Sheet {
        gl::TextureHandle texture;
        gl::FramebufferHandle framebuffer;
        glm::ivec2 size{0};
        std::uint64_t revision = 0;  // of what it holds; 0: nothing
        void hold(const optics::Image& image, std::uint64_t new_revision);
        void draw(const renderer::Rows& rows, const glm::ivec2& window) const;
    };
    Sheet base_;
    Sheet growing_;
};

}  // namespace cairn::app
