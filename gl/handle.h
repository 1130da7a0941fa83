#pragma once

#include <cstdint>
#include <utility>

namespace cairn::gl {

/// Owns one OpenGL name (a GLuint, which is an std::uint32_t); 0 owns nothing. Destroy it while its context
/// is current.
template <void (*Delete)(std::uint32_t)>
class Handle {
public:
    Handle() = default;
    explicit Handle(std::uint32_t id) : id_(id) {}
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
    [[nodiscard]] std::uint32_t id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

private:
    std::uint32_t id_ = 0;
};

namespace detail {
void delete_buffer(std::uint32_t id);
void delete_framebuffer(std::uint32_t id);
void delete_program(std::uint32_t id);
void delete_query(std::uint32_t id);
void delete_shader(std::uint32_t id);
void delete_texture(std::uint32_t id);
void delete_vertex_array(std::uint32_t id);
}  // namespace detail

using BufferHandle = Handle<detail::delete_buffer>;
using FramebufferHandle = Handle<detail::delete_framebuffer>;
using ProgramHandle = Handle<detail::delete_program>;
using QueryHandle = Handle<detail::delete_query>;
using ShaderHandle = Handle<detail::delete_shader>;
using TextureHandle = Handle<detail::delete_texture>;
using VertexArrayHandle = Handle<detail::delete_vertex_array>;

}  // namespace cairn::gl
