#include "renderer/mesh/mesh_targets.h"

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::renderer {

MeshTargets::MeshTargets(const glm::ivec2& size, const std::vector<GLenum>& formats) : size_(size) {
    GLuint framebuffer = 0;
    glCreateFramebuffers(1, &framebuffer);
    framebuffer_ = gl::FramebufferHandle(framebuffer);
    std::vector<GLenum> draw_buffers;
    for (const GLenum format : formats) {
        GLuint texture = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        textures_.emplace_back(texture);
        glTextureStorage2D(texture, 1, format, size.x, size.y);
        glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + GLenum(draw_buffers.size());
        glNamedFramebufferTexture(framebuffer, attachment, texture, 0);
        draw_buffers.push_back(attachment);
    }
    glNamedFramebufferDrawBuffers(framebuffer, GLsizei(draw_buffers.size()), draw_buffers.data());
    if (glGetError() == GL_OUT_OF_MEMORY ||
        glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(Fault::memory, "render targets of meshes",
                    fmt::format("the driver refuses {} x {} pixels", size.x, size.y),
                    "choose a smaller picture");
    }
}

}  // namespace cairn::renderer
