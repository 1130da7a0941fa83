#include "gl/handle.h"

#include <type_traits>

#include <glad/gl.h>

namespace cairn::gl::detail {

static_assert(std::is_same_v<GLuint, std::uint32_t>, "Handle spells the type of OpenGL's names out");

void delete_buffer(std::uint32_t id) {
    glDeleteBuffers(1, &id);
}
void delete_framebuffer(std::uint32_t id) {
    glDeleteFramebuffers(1, &id);
}
void delete_program(std::uint32_t id) {
    glDeleteProgram(id);
}
void delete_query(std::uint32_t id) {
    glDeleteQueries(1, &id);
}
void delete_shader(std::uint32_t id) {
    glDeleteShader(id);
}
void delete_texture(std::uint32_t id) {
    glDeleteTextures(1, &id);
}
void delete_vertex_array(std::uint32_t id) {
    glDeleteVertexArrays(1, &id);
}

}  // namespace cairn::gl::detail
