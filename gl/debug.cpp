#include <utility>

#include <fmt/format.h>
#include <glad/gl.h>

#include "gl/context.h"

namespace cairn::gl {
namespace {

void GLAPIENTRY on_message(GLenum /*source*/, GLenum type, GLuint id, GLenum /*severity*/, GLsizei length,
                           const GLchar* message, const void* user) {
    if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
    auto* const log = static_cast<DebugLog*>(const_cast<void*>(user));
    log->add(fmt::format("{} {}: {}", type == GL_DEBUG_TYPE_ERROR ? "error" : "undefined behaviour", id,
                         std::string(message, std::size_t(length))));
}

}  // namespace

void DebugLog::attach() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_message, this);
}

void DebugLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> DebugLog::take() {
    for (GLenum code = glGetError(); code != GL_NO_ERROR; code = glGetError()) {
        add(fmt::format("glGetError {:#x}", code));
    }
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

}  // namespace cairn::gl
