// inside_gl SCENE OUTPUT.ppm: Cairn in a program that has a window, an OpenGL context and a renderer of its
// own. The program shows Cairn's picture behind a triangle that it draws itself.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#define GLFW_INCLUDE_GLCOREARB
#define GL_GLEXT_PROTOTYPES
#include <GLFW/glfw3.h>
#include <cairn/base/error.h>
#include <cairn/gl/context.h>
#include <cairn/optics/camera.h>
#include <cairn/renderer/open_content.h>
#include <cairn/renderer/renderer.h>

#include "image_file.h"

namespace {

constexpr int width = 320;
constexpr int height = 240;

constexpr const char* vertex_text = R"(#version 450 core
layout(location = 0) uniform float size;
out vec2 place;
void main() {
    const vec2 corners[3] = vec2[](vec2(-1.0, -1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0));
    place = 0.5 + 0.5 * corners[gl_VertexID];
    gl_Position = vec4(size * corners[gl_VertexID] + (size - 1.0), 0.0, 1.0);
})";
constexpr const char* picture_text = R"(#version 450 core
layout(binding = 0) uniform sampler2D picture;
in vec2 place;
out vec4 color;
void main() { color = texture(picture, vec2(place.x, 1.0 - place.y)); })";
constexpr const char* triangle_text = R"(#version 450 core
out vec4 color;
void main() { color = vec4(1.0, 0.0, 0.0, 1.0); })";

/// The program without Cairn: a renderer that draws a picture and a triangle.
class OwnRenderer {
public:
    OwnRenderer() {
        picture_program_ = link(vertex_text, picture_text);
        triangle_program_ = link(vertex_text, triangle_text);
        glCreateVertexArrays(1, &vertex_array_);
        glCreateTextures(GL_TEXTURE_2D, 1, &texture_);
        glTextureStorage2D(texture_, 1, GL_RGBA8, width, height);
        glTextureParameteri(texture_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        // States that are set once, and that other code must leave as they are.
        glViewport(0, 0, width, height);
        glBindVertexArray(vertex_array_);
        glEnable(GL_CULL_FACE);
    }

    void set_picture(const cairn::optics::Image& image) const {
        glTextureSubImage2D(texture_, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    }

    /// Draws a pass. It binds its program and its texture, because Cairn changes these bindings.
    void draw() const {
        glBindTextureUnit(0, texture_);
        glProgramUniform1f(picture_program_, 0, 1.0F);
        glUseProgram(picture_program_);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glProgramUniform1f(triangle_program_, 0, 0.25F);
        glUseProgram(triangle_program_);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

private:
    static GLuint link(const char* vertex, const char* fragment) {
        const GLuint program = glCreateProgram();
        const std::array<std::pair<GLenum, const char*>, 2> stages = {
            {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}};
        for (const auto& [kind, text] : stages) {
            const GLuint shader = glCreateShader(kind);
            glShaderSource(shader, 1, &text, nullptr);
            glCompileShader(shader);
            glAttachShader(program, shader);
            glDeleteShader(shader);
        }
        glLinkProgram(program);
        return program;
    }

    GLuint picture_program_ = 0;
    GLuint triangle_program_ = 0;
    GLuint vertex_array_ = 0;
    GLuint texture_ = 0;
};

/// The program's states that its renderer sets once.
std::array<GLint, 7> own_states() {
    std::array<GLint, 7> states{};
    glGetIntegerv(GL_VIEWPORT, states.data());
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &states[4]);
    states[5] = glIsEnabled(GL_CULL_FACE);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &states[6]);
    return states;
}

cairn::optics::Image shown_picture() {
    cairn::optics::Image image{width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 4)};
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    for (int row = 0; row < height / 2; ++row) {  // OpenGL's first row is the lowest
        const auto upper = image.rgba.begin() + std::ptrdiff_t(row) * width * 4;
        const auto lower = image.rgba.begin() + std::ptrdiff_t(height - 1 - row) * width * 4;
        std::swap_ranges(upper, upper + std::ptrdiff_t(width) * 4, lower);
    }
    return image;
}

int show(const char* scene, const char* output) {
    OwnRenderer own;
    const std::array<GLint, 7> before = own_states();

    // The context stays this program's. Cairn's objects must be destroyed before it.
    const auto context =
        cairn::gl::adopt_context(reinterpret_cast<void* (*)(const char*)>(glfwGetProcAddress));
    const cairn::renderer::ContentSource source(scene);
    cairn::renderer::Renderer renderer(source.content());
    cairn::renderer::View view;
    view.size = {width, height};
    view.camera = cairn::optics::framing_camera(source.bounds(), view.size.aspect());
    own.set_picture(renderer.render(view).image);

    if (own_states() != before) {
        std::fprintf(stderr, "the program's states have changed\n");
        return 1;
    }
    own.draw();
    if (glGetError() != GL_NO_ERROR) {
        std::fprintf(stderr, "OpenGL reported an error\n");
        return 1;
    }
    return write_ppm(output, shown_picture()) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s SCENE OUTPUT.ppm\n", argv[0]);
        return 2;
    }
    if (glfwInit() != GLFW_TRUE) {
        std::fprintf(stderr, "no window system\n");
        return 1;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow* window = glfwCreateWindow(width, height, "Cairn inside", nullptr, nullptr);
    int code = 1;
    if (window != nullptr) {
        glfwMakeContextCurrent(window);
        try {
            code = show(argv[1], argv[2]);
        } catch (const cairn::Error& error) {
            std::fprintf(stderr, "%s\n  %s\n", error.what(), error.way_out().c_str());
        }
    }
    glfwTerminate();
    return code;
}
