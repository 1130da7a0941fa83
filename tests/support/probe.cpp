#include "tests/support/probe.h"

#include <memory>
#include <utility>

#include "base/error.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/march_programs.h"
#include "renderer/produce/fractal_content.h"
#include "shaders/interop/tile_query.h"
#include "shaders/interop/windows.h"

namespace cairn::test {
namespace {

constexpr GLuint probe_binding = 5;

constexpr const char* probe_shader = R"(
struct Probe { vec4 origin_t; vec4 direction; ivec4 voxel_window; ivec4 state; };
layout(std430, binding = 5) buffer ProbeBlock { Probe probes[]; };
layout(local_size_x = 64) in;
uniform uint probe_count;
ivec4 seen;

bool visit(inout Ray ray, Sample s) {
    seen = ivec4(ivec3(s.centre - 0.5 * s.side), findMSB(uint(s.side)));
    return false;
}

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= probe_count || probes[i].state.x > 1) return;
    Ray ray = make_ray(probes[i].origin_t.xyz, probes[i].direction.xyz, 1e30, 0.0, 0.0);
#if WINDOWS
    ray.origin = windows.of[0].eye;
    ray.from_eye = true;
#endif
    seen = ivec4(-1);
    bool inside = true;
    if (probes[i].state.x == 0) {
        inside = enter_windows(ray);
    } else {
#if WINDOWS
        while (ray.window < probes[i].voxel_window.w) coarsen(ray);
#endif
        ray.cell = probes[i].voxel_window.xyz;
        ray.t = probes[i].origin_t.w;
    }
    const int end = inside ? march(ray) : MARCH_DONE;
    probes[i].voxel_window.xyz = end == MARCH_MISSING ? ray.cell : seen.xyz;
    probes[i].origin_t.w = ray.t;
#if WINDOWS
    probes[i].voxel_window.w = ray.window;
#endif
    if (end == MARCH_MISSING) atomicAdd(counters.waiting_primary, 1u);
    probes[i].state = ivec4(end == MARCH_MISSING ? 1 : seen.w >= 0 ? 2 : 3, seen.w, 0, 0);
}
)";

gl::Program build(const renderer::TreeShape& shape) {
    const auto traversal =
        shape.has_windows() ? renderer::Traversal::restart : renderer::Traversal::mini_stack;
    gl::Defines defines = renderer::defines({.shape = shape, .traversal = traversal});
    for (const auto& define : renderer::defines(renderer::MarchVariant{}))
        defines.push_back(define);
    defines.emplace_back("RAYS_WIDEN", "0");
    defines.emplace_back("VISIT_TURNS", "0");
    defines.emplace_back("FIRST_MARK_ENDS", "0");
    return build_on_march(defines, probe_shader);
}

}  // namespace

gl::Program build_on_march(const gl::Defines& defines, const std::string& added) {
    const std::string text = gl::ShaderSource().resolve("march/march.glsl", defines).text + added;
    const char* source = text.c_str();
    const gl::ShaderHandle shader(glCreateShader(GL_COMPUTE_SHADER));
    glShaderSource(shader.id(), 1, &source, nullptr);
    glCompileShader(shader.id());
    gl::ProgramHandle program(glCreateProgram());
    glAttachShader(program.id(), shader.id());
    glLinkProgram(program.id());
    GLint linked = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked == 0) {
        std::string log(4000, ' ');
        glGetShaderInfoLog(shader.id(), GLsizei(log.size()), nullptr, log.data());
        throw Error(Fault::internal, "probe", log, "mend the shader that the test adds");
    }
    return gl::Program(std::move(program));
}

Prober::Prober(const renderer::TreeShape& shape, std::size_t brick_pool_bytes, std::size_t node_pool_bytes)
    : cache_(std::make_unique<renderer::FractalContent>(shape),
             {.node_bytes = node_pool_bytes, .brick_bytes = brick_pool_bytes}),
      program_(build(shape)),
      windows_(sizeof(glm::ivec4) + MAX_WINDOWS * sizeof(interop::MarchWindow), "windows"),
      queries_(QUERY_CAPACITY, renderer::TileQueries::list, shape.has_windows(), {}) {}

void Prober::run(std::vector<Probe>& probes, const std::vector<renderer::Window>& windows,
                 const renderer::TilePoint& eye) {
    const renderer::TreeShape& shape = cache_.shape();
    std::vector<interop::MarchWindow> marched =
        renderer::make_ray_windows(windows, shape, eye, nullptr, glm::dvec3(0, 1, 0));
    gl::Buffer buffer(probes.size() * sizeof(Probe), "probes");
    buffer.write(0, probes.data(), buffer.size_bytes());
    queries_.begin_frame({}, cache_.tree().entry_count(), cache_.pool().slot_count());
    for (;;) {
        if (shape.has_windows()) {
            renderer::find_tiles(windows, cache_.tree(), marched,
                                 [&](std::uint32_t entry) { (void)cache_.subdivide(entry); });
            cache_.upload();
            const glm::ivec4 count(int(marched.size()), 0, 0, 0);
            windows_.write(0, &count, sizeof(count));
            windows_.write(sizeof(count), marched.data(), marched.size() * sizeof(interop::MarchWindow));
            windows_.bind_uniform(UBO_WINDOWS);
        }
        queries_.begin_pass(false);
        buffer.bind_storage(probe_binding);
        cache_.tree().bind_for_reading();
        cache_.pool().bind_for_reading();
        program_.set("probe_count", unsigned(probes.size()));
        program_.set("pass_number", round_.number);
        queries_.set(program_);
        program_.use();
        gl::dispatch_threads(probes.size(), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        const renderer::QueryBuffer::Reports reports = queries_.read(round_);
        round_ = round_.next();
        cache_.begin_round(round_, reports.brick_stamps);
        if (reports.counters.waiting_primary == 0) break;
        cache_.answer(reports.queries);
        cache_.upload();
    }
    buffer.read(0, probes.data(), buffer.size_bytes());
}

}  // namespace cairn::test
