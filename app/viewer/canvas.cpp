#include "app/viewer/canvas.h"

#include <glad/gl.h>

namespace cairn::app {

void Canvas::Sheet::hold(const optics::Image& image, std::uint64_t new_revision) {
    if (revision == new_revision) return;
    revision = new_revision;
    if (size != glm::ivec2(image.width, image.height)) {
        size = {image.width, image.height};
        GLuint name = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &name);
        texture = gl::TextureHandle(name);
        glTextureStorage2D(name, 1, GL_RGBA8, size.x, size.y);
        GLuint target = 0;
        glCreateFramebuffers(1, &target);
        framebuffer = gl::FramebufferHandle(target);
        glNamedFramebufferTexture(target, GL_COLOR_ATTACHMENT0, name, 0);
    }
    glTextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
}

void Canvas::Sheet::draw(const renderer::Rows& rows, const glm::ivec2& window) const {
    // Row 0 is a picture's top and a window's bottom.
    const auto y_of = [&](int row) { return window.y - int(std::int64_t(row) * window.y / size.y); };
    const int end = rows.first + rows.count;
    glBlitNamedFramebuffer(framebuffer.id(), 0, 0, rows.first, size.x, end, 0, y_of(rows.first), window.x,
                           y_of(end), GL_COLOR_BUFFER_BIT, size == window ? GL_NEAREST : GL_LINEAR);
}

void Canvas::draw(const optics::Image& image, std::uint64_t revision, const glm::ivec2& window) {
    if (image.rgba.empty()) return;
    base_.hold(image, revision);
    base_.draw({0, image.height}, window);
}

void Canvas::draw(const Refinement& growing, std::uint64_t revision, const glm::ivec2& window) {
    if (growing.empty()) return;
    growing_.hold(growing.image(), revision);
    for (const Band& band : growing.bands())
        growing_.draw(band.rows, window);
}

}  // namespace cairn::app
