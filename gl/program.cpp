#include "gl/program.h"

#include <algorithm>
#include <regex>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "base/error.h"
#include "gl/context.h"

namespace cairn::gl {
namespace {

/// Mesa writes "2:52(10): error", NVIDIA "2(52) : error": both become "march/march.glsl:52: error".
std::string with_file_names(const std::string& log, const ResolvedSource& source) {
    static const std::regex place(R"(^(?:ERROR: |WARNING: )?(\d+)[:(](\d+)(?:\(\d+\)|\))?\s*:?)");
    std::string out;
    std::size_t start = 0;
    while (start < log.size()) {
        std::size_t end = log.find('\n', start);
        if (end == std::string::npos) end = log.size();
        const std::string line = log.substr(start, end - start);
        std::smatch match;
        std::size_t file = 0;
        if (std::regex_search(line, match, place) && match[1].length() < 4 &&
            (file = std::stoul(match[1])) < source.files.size()) {
            out += fmt::format("\n  {}:{}:{}", source.files[file], match[2].str(), match.suffix().str());
            if (!source.included_from[file].empty()) {
                out += fmt::format("   (included from {})", source.included_from[file]);
            }
        } else if (!line.empty()) {
            out += "\n  " + line;
        }
        start = end + 1;
    }
    return out;
}

ShaderHandle compile(GLenum stage, const ShaderSource& source, std::string_view name,
                     const Defines& defines) {
    const ResolvedSource resolved = source.resolve(name, defines);
    ShaderHandle shader(glCreateShader(stage));
    const char* text = resolved.text.c_str();
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    GLint ok = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return shader;
    GLint length = 0;
    glGetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader.id(), GLsizei(log.size()), nullptr, log.data());
    log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
    throw Error(Fault::context, fmt::format("shader {}", name),
                fmt::format("did not compile on \"{}\"{}", driver_name(), with_file_names(log, resolved)),
                "update the driver, or choose another ContextOptions::kind");
}

Program link(std::initializer_list<const ShaderHandle*> shaders, std::string_view name) {
    ProgramHandle program(glCreateProgram());
    for (const ShaderHandle* shader : shaders) {
        if (*shader) glAttachShader(program.id(), shader->id());
    }
    glLinkProgram(program.id());
    GLint ok = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &ok);
    if (ok != GL_TRUE) {
        GLint length = 0;
        glGetProgramiv(program.id(), GL_INFO_LOG_LENGTH, &length);
        std::string log(std::size_t(std::max(length, 1)), '\0');
        glGetProgramInfoLog(program.id(), GLsizei(log.size()), nullptr, log.data());
        throw Error(Fault::context, fmt::format("shader {}", name),
                    fmt::format("did not link on \"{}\": {}", driver_name(), log.c_str()));
    }
    for (const ShaderHandle* shader : shaders) {
        if (*shader) glDetachShader(program.id(), shader->id());
    }
    return Program(std::move(program));
}

}  // namespace

void Program::set(const char* name, int value) const {
    glProgramUniform1i(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, unsigned value) const {
    glProgramUniform1ui(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, float value) const {
    glProgramUniform1f(id(), glGetUniformLocation(id(), name), value);
}
void Program::set(const char* name, const glm::ivec2& value) const {
    glProgramUniform2iv(id(), glGetUniformLocation(id(), name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::ivec3& value) const {
    glProgramUniform3iv(id(), glGetUniformLocation(id(), name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec3& value) const {
    glProgramUniform3fv(id(), glGetUniformLocation(id(), name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec4& value) const {
    glProgramUniform4fv(id(), glGetUniformLocation(id(), name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::mat4& value) const {
    glProgramUniformMatrix4fv(id(), glGetUniformLocation(id(), name), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const char* name, std::span<const glm::ivec4> values) const {
    glProgramUniform4iv(id(), glGetUniformLocation(id(), name), GLsizei(values.size()),
                        reinterpret_cast<const GLint*>(values.data()));
}

Program build_compute(const ShaderSource& source, std::string_view name, const Defines& defines) {
    const ShaderHandle shader = compile(GL_COMPUTE_SHADER, source, name, defines);
    return link({&shader}, name);
}

Program build_raster(const ShaderSource& source, std::string_view vertex, std::string_view fragment,
                     std::string_view geometry, const Defines& defines) {
    const ShaderHandle vertex_shader = compile(GL_VERTEX_SHADER, source, vertex, defines);
    const ShaderHandle fragment_shader = compile(GL_FRAGMENT_SHADER, source, fragment, defines);
    ShaderHandle geometry_shader;
    if (!geometry.empty()) geometry_shader = compile(GL_GEOMETRY_SHADER, source, geometry, defines);
    return link({&vertex_shader, &fragment_shader, &geometry_shader}, vertex);
}

void dispatch_threads(std::size_t threads, unsigned group_size) {
    constexpr std::size_t axis_limit = 65535;  // the least that OpenGL 4.5 promises
    const std::size_t groups = (threads + group_size - 1) / group_size;
    if (groups == 0) return;
    const std::size_t rows = (groups + axis_limit - 1) / axis_limit;
    const std::size_t columns = (groups + rows - 1) / rows;
    glDispatchCompute(GLuint(columns), GLuint(rows), 1);
}

}  // namespace cairn::gl
