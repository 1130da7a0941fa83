#include "tests/support/probe.h"

#include <algorithm>

#include "base/error.h"
#include "gl/handle.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "renderer/march/march_programs.h"
#include "shaders/interop/march.h"
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
        ray.voxel = probes[i].voxel_window.xyz;
        ray.t = probes[i].origin_t.w;
    }
    const int end = inside ? march(ray) : MARCH_DONE;
    probes[i].voxel_window.xyz = end == MARCH_MISSING ? ray.voxel : seen.xyz;
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
    const std::string text = gl::ShaderSource().resolve("march/march.glsl", defines).text + probe_shader;
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
        throw Error(Fault::internal, "probe", log, "mend the shader in tests/support/probe.cpp");
    }
    return gl::Program(std::move(program));
}

}  // namespace

Prober::Prober(const renderer::TreeShape& shape, std::size_t brick_pool_bytes, std::size_t node_pool_bytes)
    : shape_(shape),
      content_(shape),
      pool_(shape, false, brick_pool_bytes),
      tree_(shape, pool_.slot_count(), node_pool_bytes, content_.oracle().child_mask({})),
      program_(build(shape)),
      windows_(sizeof(glm::ivec4) + MAX_WINDOWS * sizeof(interop::MarchWindow), "windows"),
      queries_(sizeof(interop::MarchCounters) + QUERY_CAPACITY * sizeof(std::uint32_t), "queries"),
      usage_((std::size_t(pool_.slot_count()) + (2 * std::size_t(tree_.entry_count()) + 31) / 32) * 4,
             "usage") {
    usage_.fill(0);
}

void Prober::subdivide(std::uint32_t entry) {
    const std::optional<std::uint32_t> first = tree_.add_children(entry);
    for (int child = 0; first && child < shape_.child_count(); ++child) {
        const renderer::Tile tile = renderer::child_of(tree_.tile(entry), shape_.n, child);
        if (renderer::fractal::occupied(tile.position, shape_.n_shift() * tile.level))
            tree_.set_child_mask(*first + std::uint32_t(child), content_.oracle().child_mask(tile));
    }
}

void Prober::serve(const std::vector<std::uint32_t>& queries) {
    std::vector<renderer::BrickRequest> requests;
    for (const std::uint32_t query : queries) {
        if (query % 2 == QUERY_CHILDREN) {
            if (tree_.wants_children(query / 2)) subdivide(query / 2);
        } else if (tree_.wants_brick(query / 2)) {
            if (const std::optional<int> slot = tree_.add_brick(query / 2))
                requests.push_back({tree_.tile(query / 2), *slot});
        }
    }
    content_.producer().produce(requests, pool_);
    tree_.upload();
}

void Prober::run(std::vector<Probe>& probes, const std::vector<renderer::Window>& windows,
                 const renderer::Place& eye) {
    std::vector<interop::MarchWindow> marched =
        renderer::march_windows(windows, shape_, eye, nullptr, glm::dvec3(0, 1, 0));
    gl::Buffer buffer(probes.size() * sizeof(Probe), "probes");
    buffer.write(0, probes.data(), buffer.size_bytes());
    const std::size_t bits = std::size_t(pool_.slot_count()) * 4;
    for (;;) {
        if (shape_.has_windows()) {
            renderer::find_tiles(windows, tree_, marched, [&](std::uint32_t entry) { subdivide(entry); });
            tree_.upload();
            const glm::ivec4 count(int(marched.size()), 0, 0, 0);
            windows_.write(0, &count, sizeof(count));
            windows_.write(sizeof(count), marched.data(), marched.size() * sizeof(interop::MarchWindow));
            windows_.bind_uniform(UBO_WINDOWS);
        }
        usage_.fill(bits, usage_.size_bytes() - bits, 0);
        queries_.fill(0, sizeof(interop::MarchCounters), 0);
        queries_.bind_storage(SSBO_QUERIES);
        usage_.bind_storage(SSBO_USAGE);
        buffer.bind_storage(probe_binding);
        tree_.bind_for_reading();
        pool_.bind_for_reading();
        program_.set("probe_count", unsigned(probes.size()));
        program_.set("pass_number", round_);
        program_.set("usage_query_offset", unsigned(pool_.slot_count()));
        program_.set("query_capacity", unsigned(QUERY_CAPACITY));
        program_.use();
        gl::dispatch_threads(probes.size(), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        interop::MarchCounters counters{};
        queries_.read(0, &counters, sizeof(counters));
        ++round_;
        tree_.begin_round(round_, usage_.read_all<std::uint32_t>(std::size_t(pool_.slot_count())));
        if (counters.waiting_primary == 0) break;
        serve(queries_.read_all<std::uint32_t>(std::min<std::size_t>(counters.queries, QUERY_CAPACITY),
                                               sizeof(counters)));
    }
    buffer.read(0, probes.data(), buffer.size_bytes());
}

}  // namespace cairn::test
