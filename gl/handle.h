#pragma once

#include <utility>

#include <glad/gl.h>

namespace cairn::gl {

/// Owns one OpenGL name; 0 owns nothing. Destroy it while its context is current.
template <void (*Delete)(GLuint)>
class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint id) : id_(id) {}
    Handle(const Handle&) = delete;
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Handle& operator=(const Handle&) = delete;
    Handle& operator=(Handle&& other) noexcept {
        Handle taken(std::move(other));
        std::swap(id_, taken.id_);
        return *this;
    }
    ~Handle() {
        if (id_ != 0) Delete(id_);
    }
    [[nodiscard]] GLuint id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

private:
    GLuint id_ = 0;
};

namespace detail {
inline void delete_buffer(GLuint id) {
    glDeleteBuffers(1, &id);
}
inline void delete_framebuffer(GLuint id) {
    glDeleteFramebuffers(1, &id);
}
inline void delete_program(GLuint id) {
    glDeleteProgram(id);
}
inline void delete_query(GLuint id) {
    glDeleteQueries(1, &id);
}
inline void delete_shader(GLuint id) {
    glDeleteShader(id);
}
inline void delete_texture(GLuint id) {
    glDeleteTextures(1, &id);
}
inline void delete_vertex_array(GLuint id) {
    glDeleteVertexArrays(1, &id);
}
}  // namespace detail

using BufferHandle = Handle<detail::delete_buffer>;
using FramebufferHandle = Handle<detail::delete_framebuffer>;
using ProgramHandle = Handle<detail::delete_program>;
using QueryHandle = Handle<detail::delete_query>;
using ShaderHandle = Handle<detail::delete_shader>;
using TextureHandle = Handle<detail::delete_texture>;
using VertexArrayHandle = Handle<detail::delete_vertex_array>;

}  // namespace cairn::gl
