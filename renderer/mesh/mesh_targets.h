#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glad/gl.h>
#include <glm/glm.hpp>

#include "gl/handle.h"

namespace cairn::renderer {

/// Render targets without a depth buffer: textures of one size that are drawn to together.
class MeshTargets {
public:
    MeshTargets() = default;
    /// @param formats  one per draw buffer, in their order.
    /// @throws Error  Fault::memory if the driver refuses the textures.
    MeshTargets(const glm::ivec2& size, const std::vector<GLenum>& formats);

    [[nodiscard]] const glm::ivec2& size() const { return size_; }
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }
    [[nodiscard]] GLuint texture(std::size_t target) const { return textures_[target].id(); }

private:
    glm::ivec2 size_{0};
    std::vector<gl::TextureHandle> textures_;
    gl::FramebufferHandle framebuffer_;
};

}  // namespace cairn::renderer
