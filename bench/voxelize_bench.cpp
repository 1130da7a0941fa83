// The conservative method beside plain rasterization of the same triangles from three directions, in one run
// on one context; the rasterizer finds fewer voxels, and writes none.
//
//     voxelize_bench OUT_FOLDER [SCENE [RESOLUTION]]
//
// Prints a table and writes OUT_FOLDER/voxelize.csv. The two are measured in turn, so that the ratio holds
// when the machine's speed drifts.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "gl/context.h"
#include "gl/program.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "voxelizer/conservative_voxelizer.h"

namespace {

using namespace cairn;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// Draws all triangles along x, y and z, orthographically, with nothing written: depth test, culling and
/// colour writes are off, and the framebuffer has one attachment of eight bits.
class ThreeDirections {
public:
    ThreeDirections(const voxelizer::Surface& surface, int resolution) : resolution_(resolution) {
        for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
            std::vector<glm::vec3> positions;
            std::vector<std::uint32_t> indices;
            for (const auto& p : chunk.positions) {
                positions.push_back(glm::vec3(p[0], p[1], p[2]) * (2.0F / float(1 << LATTICE_BITS)) - 1.0F);
            }
            for (const interop::SurfaceTriangle& t : chunk.triangles) {
                for (int corner = 0; corner < 3; ++corner)
                    indices.push_back(t.vertices_material[corner]);
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

    /// Milliseconds from an idle driver to an idle driver.
    [[nodiscard]] double draw() const {
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
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }

private:
    struct Draw {
        gl::Buffer positions;
        gl::Buffer indices;
        GLsizei count;
    };

    static gl::Program build_program() {
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
        if (linked != GL_TRUE)
            throw Error(Fault::context, "voxelize_bench", "the rasterizing program did not link");
        return gl::Program(std::move(program));
    }

    int resolution_;
    std::vector<Draw> draws_;
    gl::TextureHandle target_;
    gl::FramebufferHandle framebuffer_;
    gl::VertexArrayHandle vertices_;
    gl::Program program_;
};

std::string measure(const std::string& name, int resolution) {
    const scenes::Scene scene = scenes::load(name);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const voxelizer::Surface surface =
        voxelizer::build_surface(scene, snapshot, voxelizer::grid_around(snapshot.bounds, resolution));
    const voxelizer::Region region = voxelizer::whole(surface.grid);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::ConservativeVoxelizer voxelizer;
    const ThreeDirections raster(surface, resolution);

    const std::uint64_t occupied = voxelizer.voxelize(on_gpu, region).count();
    (void)raster.draw();
    std::vector<double> ours;
    std::vector<double> theirs;
    std::vector<double> ratio;
    for (int i = 0; i < 15; ++i) {
        (void)voxelizer.voxelize(on_gpu, region);
        ours.push_back(voxelizer.last_milliseconds());
        theirs.push_back(raster.draw());
        ratio.push_back(ours.back() / theirs.back());
    }
    fmt::print(
        "{:<32} {:>5}  {:>9} triangles {:>9} voxels  conservative {:>8.1f} ms  three directions {:>8.1f} ms  "
        "ratio {:.2f}\n",
        name, resolution, surface.triangle_count, occupied, median(ours), median(theirs), median(ratio));
    return fmt::format("{},{},{},{},{:.2f},{:.2f},{:.3f},\"{}\",{}\n", name, resolution,
                       surface.triangle_count, occupied, median(ours), median(theirs), median(ratio),
                       gl::driver_name(), std::thread::hardware_concurrency());
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        fmt::print(stderr, "usage: voxelize_bench OUT_FOLDER [SCENE [RESOLUTION]]\n");
        return 2;
    }
    const auto context = gl::create_context();
    fmt::print("{}\n", gl::driver_name());
    std::string csv =
        "scene,resolution,triangles,occupied,conservative_ms,three_directions_ms,ratio,driver,threads\n";
    const std::vector<std::string> scenes =
        argc > 2 ? std::vector<std::string>{argv[2]}
                 : std::vector<std::string>{"builtin:knot", "builtin:tree", "builtin:needles"};
    const std::vector<int> resolutions =
        argc > 3 ? std::vector<int>{std::atoi(argv[3])} : std::vector<int>{128, 256, 512};
    for (const std::string& scene : scenes) {
        for (const int resolution : resolutions)
            csv += measure(scene, resolution);
    }
    std::filesystem::create_directories(argv[1]);
    OutputFile file(std::filesystem::path(argv[1]) / "voxelize.csv");
    file.write(csv.data(), csv.size());
    file.commit();
    return 0;
} catch (const cairn::Error& error) {
    fmt::print(stderr, "error: {}\n  {}\n", error.what(), error.way_out());
    return 1;
}
