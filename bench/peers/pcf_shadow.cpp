#include "bench/peers/pcf_shadow.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "gl/draw_state.h"
#include "shaders/interop/shadow_map.h"

namespace cairn::bench {
namespace {

constexpr unsigned group_size = 64;
constexpr double near_margin = 0.999;

/// The vertex shader, for vertices and materials of ShadowMesh, whose numbers are prepended.
constexpr const char* vertex_text = R"(
layout(location = ATTRIBUTE_SHADOW_POSITION) in vec3 position;
layout(location = ATTRIBUTE_SHADOW_COLOR) in vec4 color;
layout(location = ATTRIBUTE_SHADOW_TEXCOORD) in vec2 texcoord;
uniform mat4 clip_from_mesh;
out vec2 surface_texcoord;
out float surface_alpha;
void main() {
    gl_Position = clip_from_mesh * vec4(position, 1.0);
    surface_texcoord = texcoord;
    surface_alpha = color.a;
}
)";
constexpr const char* fragment_text = R"(
layout(binding = TEXTURE_SHADOW_BASE_COLOR) uniform sampler2D base_color_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;
in vec2 surface_texcoord;
in float surface_alpha;
void main() {
    const float alpha = textureLod(base_color_texture, surface_texcoord, 0.0).a * base_color.a * surface_alpha;
    if (alpha < alpha_cutoff) discard;
}
)";

/// Places are given by t, their place on the map's plane, and q, of which depth is a linear function: t = (x
/// / z, y / z) and q = 1 / z for a positional light, t = (x, y) and q = z for a light at infinity. Then a
/// plane of the scene is a plane of (t, q), and a light of half size h, seen past a blocker, is h |q of the
/// blocker - q| wide in t.
constexpr const char* evaluate_text = R"(
layout(local_size_x = GROUP_SIZE) in;
layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };  // in light space
layout(std430, binding = 1) readonly buffer Normals { vec4 normals[]; };
layout(std430, binding = 2) writeonly buffer Shares { float shares[]; };
layout(binding = 0) uniform sampler2DShadow lit_map;
layout(binding = 1) uniform sampler2D depth_map;
uniform int count;
uniform int kernel;
uniform vec4 window;        // low and high t
uniform vec4 depth_and_q;   // depth = x + y q; z: q of the nearest caster; w: 1 for a light at infinity
uniform vec4 half_and_texel;  // half size of the light; size of a texel in t

vec2 uv_of(vec2 t) { return (t - window.xy) / (window.zw - window.xy); }
float depth_of(float q) { return depth_and_q.x + depth_and_q.y * q; }
vec2 tap_of(int i) { return (vec2(i % kernel, i / kernel) + 0.5) / float(kernel) * 2.0 - 1.0; }

// The share of kernel^2 taps within +- width that is lit.
float filtered(vec2 t, float q, vec2 q_slope, vec2 width) {
    float sum = 0.0;
    for (int i = 0; i < kernel * kernel; ++i) {
        const vec2 offset = tap_of(i) * width;
        sum += textureLod(lit_map, vec3(uv_of(t + offset), depth_of(q + dot(q_slope, offset))), 0.0);
    }
    return sum / float(kernel * kernel);
}

#if IS_PENUMBRA
// Blockers are searched in the part of the map that the light covers on the plane of the nearest caster.
float soft(vec2 t, float q, vec2 q_slope) {
    const vec2 search = max(half_and_texel.xy * abs(depth_and_q.z - q), half_and_texel.zw);
    float sum = 0.0;
    float blockers = 0.0;
    for (int i = 0; i < kernel * kernel; ++i) {
        const vec2 offset = tap_of(i) * search;
        const float depth = textureLod(depth_map, uv_of(t + offset), 0.0).r;
        const float is_blocker = depth < depth_of(q + dot(q_slope, offset)) ? 1.0 : 0.0;
        sum += is_blocker * (depth - depth_and_q.x) / depth_and_q.y;
        blockers += is_blocker;
    }
    if (blockers == 0.0) return 1.0;
    return filtered(t, q, q_slope, max(half_and_texel.xy * abs(sum / blockers - q), half_and_texel.zw));
}
#endif

void main() {
    const uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * uint(GROUP_SIZE);
    if (i >= uint(count)) return;
    const vec3 p = points[i].xyz;
    const bool is_far = depth_and_q.w > 0.5;
    const vec2 t = is_far ? p.xy : p.xy / p.z;
    const float q = is_far ? p.z : 1.0 / p.z;
#if IS_PENUMBRA
    const vec3 n = normals[i].xyz;
    const vec2 q_slope = is_far ? -n.xy / n.z : n.xy / dot(n, p);
    shares[i] = soft(t, q, q_slope);
#else
    shares[i] = filtered(t, q, vec2(0.0), 0.5 * float(kernel) * half_and_texel.zw);
#endif
}
)";

gl::ShaderHandle compile(GLenum stage, const std::string& defines, const char* text) {
    const std::string whole = "#version 450 core\n" + defines + text;
    const char* const pointer = whole.c_str();
    gl::ShaderHandle shader(glCreateShader(stage));
    glShaderSource(shader.id(), 1, &pointer, nullptr);
    glCompileShader(shader.id());
    return shader;
}

gl::Program link(std::span<const gl::ShaderHandle> shaders) {
    gl::ProgramHandle program(glCreateProgram());
    for (const gl::ShaderHandle& shader : shaders)
        glAttachShader(program.id(), shader.id());
    glLinkProgram(program.id());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return gl::Program(std::move(program));
    std::array<char, 1024> log{};
    for (const gl::ShaderHandle& shader : shaders)
        if (log[0] == '\0') glGetShaderInfoLog(shader.id(), log.size(), nullptr, log.data());
    throw Error(Fault::context, "bench", fmt::format("a shadow map's program did not link: {}", log.data()));
}

gl::Program draw_program() {
    const std::string defines = fmt::format(
        "#define ATTRIBUTE_SHADOW_POSITION {}\n#define ATTRIBUTE_SHADOW_COLOR {}\n"
        "#define ATTRIBUTE_SHADOW_TEXCOORD {}\n#define TEXTURE_SHADOW_BASE_COLOR {}\n",
        ATTRIBUTE_SHADOW_POSITION, ATTRIBUTE_SHADOW_COLOR, ATTRIBUTE_SHADOW_TEXCOORD,
        TEXTURE_SHADOW_BASE_COLOR);
    const std::array shaders = {compile(GL_VERTEX_SHADER, defines, vertex_text),
                                compile(GL_FRAGMENT_SHADER, defines, fragment_text)};
    return link(shaders);
}

gl::Program evaluate_program(PcfFilter filter) {
    const std::string defines = fmt::format("#define GROUP_SIZE {}\n#define IS_PENUMBRA {}\n", group_size,
                                            filter == PcfFilter::penumbra ? 1 : 0);
    const std::array shaders = {compile(GL_COMPUTE_SHADER, defines, evaluate_text)};
    return link(shaders);
}

/// Light space: the light looks along +z; x is along its half_u if it has one.
glm::dmat4 light_space(const optics::Light& light, const glm::dvec3& target) {
    const bool is_flat = light.positional && light.shape != optics::LightShape::sphere;
    glm::dvec3 forward = light.positional ? target - light.position : -light.towards;
    if (is_flat) {
        const glm::dvec3 normal = glm::cross(light.half_u, light.half_v);
        forward = glm::dot(normal, forward) < 0.0 ? -normal : normal;
    }
    if (!(glm::length(forward) > 0.0)) throw Error(Fault::usage, "light", "it has no direction");
    forward = glm::normalize(forward);
    glm::dvec3 x = is_flat ? light.half_u : glm::cross(glm::dvec3(0, 1, 0), forward);
    if (glm::length(x) < 1e-9) x = glm::cross(glm::dvec3(0, 0, 1), forward);
    x = glm::normalize(x);
    const glm::dmat3 axes = glm::transpose(glm::dmat3(x, glm::cross(forward, x), forward));
    glm::dmat4 matrix(axes);
    matrix[3] = glm::dvec4(-(axes * (light.positional ? light.position : target)), 1.0);
    return matrix;
}

glm::dvec2 half_of(const optics::Light& light) {
    if (!light.positional) return glm::dvec2(std::tan(light.angle));
    // A round light is replaced by a square of the same area.
    const double square = 0.5 * std::sqrt(std::numbers::pi);
    if (light.shape == optics::LightShape::sphere) return glm::dvec2(square * light.radius);
    const glm::dvec2 half(glm::length(light.half_u), glm::length(light.half_v));
    return light.shape == optics::LightShape::disk ? square * half : half;
}

gl::Buffer upload(std::span<const glm::dvec3> vectors, const glm::dmat4& matrix, double w) {
    std::vector<glm::vec4> out;
    out.reserve(vectors.size());
    for (const glm::dvec3& v : vectors)
        out.emplace_back(glm::vec3(matrix * glm::dvec4(v, w)), 0.0F);
    return gl::Buffer::of(std::span<const glm::vec4>(out), "receivers");
}

}  // namespace

PcfShadow::PcfShadow(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                     const scenes::Snapshot& casters, const optics::Light& light,
                     std::span<const glm::dvec3> points, std::span<const glm::dvec3> normals)
    : mesh_(std::make_shared<renderer::ShadowMesh>(scene, snapshot)),
      is_perspective_(light.positional),
      half_(half_of(light)),
      count_(points.size()),
      shares_(std::max<std::size_t>(count_, 4) * sizeof(float), "shares"),
      draw_program_(draw_program()),
      fixed_program_(evaluate_program(PcfFilter::fixed)),
      penumbra_program_(evaluate_program(PcfFilter::penumbra)) {
    fit(snapshot, casters, light);
    points_ = upload(points, light_from_world_, 1.0);
    normals_ = upload(normals, light_from_world_, 0.0);
    make_samplers();
}

void PcfShadow::fit(const scenes::Snapshot& snapshot, const scenes::Snapshot& casters,
                    const optics::Light& light) {
    light_from_world_ = light_space(light, 0.5 * (casters.bounds.low + casters.bounds.high));
    low_ = glm::dvec2(1e300);
    high_ = glm::dvec2(-1e300);
    near_ = 1e300;
    far_ = -1e300;
    for (const scenes::Item& item : casters.items) {
        for (const std::uint32_t index : item.primitive->indices) {
            const glm::dvec3 p(light_from_world_ * glm::dvec4(item.world(index), 1.0));
            if (is_perspective_ && !(p.z > 0.0))
                throw Error(Fault::usage, "shadow map",
                            "what throws shadows reaches beside the light or behind it",
                            "move the light away");
            const glm::dvec2 t = is_perspective_ ? glm::dvec2(p) / p.z : glm::dvec2(p);
            low_ = glm::min(low_, t);
            high_ = glm::max(high_, t);
            near_ = std::min(near_, p.z);
            far_ = std::max(far_, p.z);
        }
    }
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner = glm::mix(snapshot.bounds.low, snapshot.bounds.high,
                                           glm::dvec3(double(i & 1), double(i >> 1 & 1), double(i >> 2)));
        far_ = std::max(far_, (light_from_world_ * glm::dvec4(corner, 1.0)).z);
    }
    const glm::dvec2 margin = 0.01 * (high_ - low_) + 1e-9 * (glm::abs(low_) + glm::abs(high_)) + 1e-12;
    low_ -= margin;
    high_ += margin;
    const double depth = far_ - near_;
    near_ = is_perspective_ ? near_ * near_margin : near_ - 0.001 * depth;
    far_ += 0.001 * depth + 1e-9 * std::abs(far_);
}

void PcfShadow::make_samplers() {
    for (const bool compares : {false, true}) {
        GLuint id = 0;
        glCreateSamplers(1, &id);
        (compares ? comparing_ : plain_) = decltype(comparing_)(id);
        for (const GLenum side : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glSamplerParameteri(id, side, compares ? GL_LINEAR : GL_NEAREST);
        for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
            glSamplerParameteri(id, axis, GL_CLAMP_TO_BORDER);
        constexpr std::array<float, 4> furthest = {1.0F, 1.0F, 1.0F, 1.0F};
        glSamplerParameterfv(id, GL_TEXTURE_BORDER_COLOR, furthest.data());
        if (!compares) continue;
        glSamplerParameteri(id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glSamplerParameteri(id, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
}

const PcfShadow::Map& PcfShadow::map_of(int size) {
    Map& map = maps_[size];
    if (map.depths) return map;
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    map.depths = gl::TextureHandle(id);
    glTextureStorage2D(id, 1, GL_DEPTH_COMPONENT24, size, size);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw Error(Fault::memory, "bench", fmt::format("a shadow map of {0}x{0} does not fit", size));
    GLuint target = 0;
    glCreateFramebuffers(1, &target);
    map.target = gl::FramebufferHandle(target);
    glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, id, 0);
    glNamedFramebufferDrawBuffer(target, GL_NONE);
    return map;
}

/// No face is culled, because open surfaces cast shadows from either side. Fragments nearer than all casters
/// are kept at the nearest depth.
void PcfShadow::draw(const Map& map, const PcfOptions& options) const {
    const gl::DrawStateGuard guard;
    glm::dmat4 clip(0.0);
    const glm::dvec2 scale = 2.0 / (high_ - low_);
    const glm::dvec2 shift = -(high_ + low_) / (high_ - low_);
    clip[0][0] = scale.x;
    clip[1][1] = scale.y;
    clip[is_perspective_ ? 2 : 3] = glm::dvec4(shift, 0.0, 1.0);
    const double depth = far_ - near_;
    clip[2][2] = is_perspective_ ? (far_ + near_) / depth : 2.0 / depth;
    clip[3][2] = is_perspective_ ? -2.0 * far_ * near_ / depth : -(far_ + near_) / depth;
    const float reach = options.filter == PcfFilter::fixed ? 0.5F * float(options.kernel + 1) : 1.0F;
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(options.slope_bias * reach, options.constant_bias);
    glViewport(0, 0, options.map_size, options.map_size);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, map.target.id());
    constexpr float furthest = 1.0F;
    glClearNamedFramebufferfv(map.target.id(), GL_DEPTH, 0, &furthest);
    draw_program_.use();
    draw_program_.set("clip_from_mesh", mesh_->from_mesh(clip * light_from_world_));
    mesh_->draw(draw_program_);
    glPolygonOffset(0.0F, 0.0F);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_CLAMP);
}

void PcfShadow::evaluate(const Map& map, const PcfOptions& options) const {
    const gl::Program& program = options.filter == PcfFilter::fixed ? fixed_program_ : penumbra_program_;
    const double depth = far_ - near_;
    const glm::dvec2 depth_of_q = is_perspective_ ? glm::dvec2(far_ / depth, -far_ * near_ / depth)
                                                  : glm::dvec2(-near_ / depth, 1.0 / depth);
    program.use();
    program.set("count", int(count_));
    program.set("kernel", options.kernel);
    program.set("window", glm::vec4(low_, high_));
    program.set("depth_and_q",
                glm::vec4(depth_of_q, is_perspective_ ? 1.0 / near_ : near_, is_perspective_ ? 0.0 : 1.0));
    program.set("half_and_texel", glm::vec4(half_, (high_ - low_) / double(options.map_size)));
    points_.bind_storage(0);
    normals_.bind_storage(1);
    shares_.bind_storage(2);
    for (const GLuint unit : {0U, 1U})
        glBindTextureUnit(unit, map.depths.id());
    glBindSampler(0, comparing_.id());
    glBindSampler(1, plain_.id());
    gl::dispatch_threads(count_, group_size);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (const GLuint unit : {0U, 1U}) {
        glBindSampler(unit, 0);
        glBindTextureUnit(unit, 0);
    }
}

PcfShadow::Result PcfShadow::shadow(const PcfOptions& options) {
    if (options.map_size < 1 || options.map_size > 16384 || options.kernel < 1 || options.kernel > 64)
        throw Error(Fault::usage, "shadow map", "1 to 16384 texels per side, and 1 to 64 taps per axis");
    const Map& map = map_of(options.map_size);
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    draw(map, options);
    if (count_ > 0) evaluate(map, options);
    glFinish();
    Result result;
    result.milliseconds = milliseconds_since(start);
    result.shares = shares_.read_all<float>(count_);
    return result;
}

}  // namespace cairn::bench
