#include "gl/buffer.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include "base/error.h"

namespace cairn::gl {

Buffer::Buffer(std::size_t size_bytes, const std::string& name) : size_bytes_(size_bytes) {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    handle_ = BufferHandle(id);
    glNamedBufferStorage(id, GLsizeiptr(size_bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
    // Other errors are bugs, and KHR_debug reports them; this one is the machine's answer to a size.
    if (glGetError() == GL_OUT_OF_MEMORY) {
        throw Error(Fault::memory, name,
                    fmt::format("the driver has no {:.1f} MiB left", double(size_bytes) / 0x1p20),
                    "choose a lower resolution or a smaller pool");
    }
    glObjectLabel(GL_BUFFER, id, GLsizei(std::min<std::size_t>(name.size(), 200)), name.data());
}

// NOLINTNEXTLINE(readability-make-member-function-const): the contents belong to the buffer
void Buffer::write(std::size_t offset_bytes, const void* data, std::size_t size_bytes) {
    if (size_bytes == 0) return;
    glNamedBufferSubData(id(), GLintptr(offset_bytes), GLsizeiptr(size_bytes), data);
}

void Buffer::read(std::size_t offset_bytes, void* data, std::size_t size_bytes) const {
    if (size_bytes == 0) return;
    // A shader's writes reach this read only past a barrier; having it here means no caller can forget it.
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(id(), GLintptr(offset_bytes), GLsizeiptr(size_bytes), data);
}

void Buffer::fill(std::uint32_t word) {
    fill(0, size_bytes_, word);
}

// NOLINTNEXTLINE(readability-make-member-function-const): the contents belong to the buffer
void Buffer::fill(std::size_t offset_bytes, std::size_t size_bytes, std::uint32_t word) {
    if (size_bytes == 0) return;
    glClearNamedBufferSubData(id(), GL_R32UI, GLintptr(offset_bytes), GLsizeiptr(size_bytes), GL_RED_INTEGER,
                              GL_UNSIGNED_INT, &word);
}

void Buffer::bind_storage(std::uint32_t binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id());
}

void Buffer::bind_uniform(std::uint32_t binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id());
}

}  // namespace cairn::gl
