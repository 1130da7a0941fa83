#pragma once

#include <span>
#include <string>
#include <string_view>

#include <glad/gl.h>
#include <glm/glm.hpp>

#include "gl/handle.h"
#include "gl/shader_source.h"

namespace cairn::gl {

/// A linked program. Uniforms are set by name; setting one that the driver removed as unused is allowed.
class Program {
public:
    Program() = default;
    explicit Program(ProgramHandle handle) : handle_(std::move(handle)) {}

    void use() const { glUseProgram(id()); }
    [[nodiscard]] GLuint id() const { return handle_.id(); }

    void set(const char* name, int value) const;
    void set(const char* name, unsigned value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::ivec2& value) const;
    void set(const char* name, const glm::ivec3& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::vec4& value) const;
    void set(const char* name, const glm::mat4& value) const;
    /// Sets the elements of an array, from its first one on.
    void set(const char* name, std::span<const glm::ivec4> values) const;

private:
    ProgramHandle handle_;
};

/// Compiles and links one compute shader.
/// @throws Error (Fault::context) with the driver's message, in which names replace file numbers.
[[nodiscard]] Program build_compute(const ShaderSource& source, std::string_view name,
                                    const Defines& defines = {});

/// Compiles and links a vertex and a fragment shader, and a geometry shader if its name is not empty.
[[nodiscard]] Program build_raster(const ShaderSource& source, std::string_view vertex,
                                   std::string_view fragment, std::string_view geometry = {},
                                   const Defines& defines = {});

/// Dispatches at least `threads` threads of the bound compute program, folded over x and y if one axis is too
/// short. A shader computes the number of its thread by thread_index() of shaders/common/thread.glsl.
void dispatch_threads(std::size_t threads, unsigned group_size);

}  // namespace cairn::gl
