#include "gl/buffer_texture.h"

#include <glad/gl.h>

namespace cairn::gl {

TextureHandle buffer_texture(std::uint32_t format, const Buffer& buffer) {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    TextureHandle texture(id);
    glTextureBuffer(id, format, buffer.id());
    return texture;
}

}  // namespace cairn::gl
