#include "gl/limits.h"

#include <glad/gl.h>

namespace cairn::gl {

Limits query_limits() {
    GLint64 storage = 0;
    GLint texels = 0;
    Limits limits;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storage);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limits.texture_3d_size);
    limits.shader_storage_bytes = std::size_t(storage);
    limits.texture_buffer_texels = std::size_t(texels);
    if (GLAD_GL_EXT_texture_filter_anisotropic != 0)
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &limits.anisotropy);
    return limits;
}

}  // namespace cairn::gl
