#include "bench/peers/three_directions.h"

#include <chrono>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"

namespace cairn::bench {
namespace {

gl::Program build_program() {
    constexpr const char* vertex =
        "#version 450 core\n"
        "layout(location = 0) in vec3 position;\n"
        "uniform int direction;\n"
        "void main() {\n"
        "    vec3 p = direction == 0 ? position.yzx : direction == 1 ? position.zxy : position;\n"
        "    gl_Position = vec4(p, 1.0);\n"
        "}\n";
    constexpr const char* fragment =
        "#version 450 core\n"
        "layout(location = 0) out float color;\n"
        "void main() { color = 1.0; }\n";
    gl::ProgramHandle program(glCreateProgram());
    for (const auto& [stage, text] :
         {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const gl::ShaderHandle shader(glCreateShader(GLenum(stage)));
        glShaderSource(shader.id(), 1, &text, nullptr);
        glCompileShader(shader.id());
        glAttachShader(program.id(), shader.id());
    }
    glLinkProgram(program.id());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) throw Error(Fault::context, "bench", "the rasterizing program did not link");
    return gl::Program(std::move(program));
}

}  // namespace

ThreeDirections::ThreeDirections(const voxelizer::Surface& surface, int resolution)
    : resolution_(resolution) {
    for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
        std::vector<glm::vec3> positions;
        std::vector<std::uint32_t> indices;
        for (const auto& p : chunk.positions) {
            positions.push_back(glm::vec3(p[0], p[1], p[2]) * (2.0F / float(1 << LATTICE_BITS)) - 1.0F);
        }
        for (const interop::SurfaceTriangle& t : chunk.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                indices.push_back(t.vertices[corner]);
        }
        draws_.push_back({gl::Buffer::of(std::span<const glm::vec3>(positions), "positions"),
                          gl::Buffer::of(std::span<const std::uint32_t>(indices), "indices"),
                          GLsizei(indices.size())});
    }
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    target_ = gl::TextureHandle(id);
    glTextureStorage2D(id, 1, GL_R8, resolution, resolution);
    glCreateFramebuffers(1, &id);
    framebuffer_ = gl::FramebufferHandle(id);
    glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT0, target_.id(), 0);
    glCreateVertexArrays(1, &id);
    vertices_ = gl::VertexArrayHandle(id);
    glVertexArrayAttribFormat(id, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(id, 0);
    program_ = build_program();
}

double ThreeDirections::draw() const {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, resolution_, resolution_);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(vertices_.id());
    program_.use();
    for (int direction = 0; direction < 3; ++direction) {
        program_.set("direction", direction);
        for (const Draw& draw : draws_) {
            glVertexArrayVertexBuffer(vertices_.id(), 0, draw.positions.id(), 0, sizeof(glm::vec3));
            glVertexArrayElementBuffer(vertices_.id(), draw.indices.id());
            glDrawElements(GL_TRIANGLES, draw.count, GL_UNSIGNED_INT, nullptr);
        }
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFinish();
    return milliseconds_since(start);
}

}  // namespace cairn::bench
