#include "bench/peers/regular_grid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include <tbb/parallel_for.h>

#include "base/clock.h"
#include "base/error.h"

namespace cairn::bench {
namespace {

constexpr unsigned group_side = 8;

constexpr const char* text = R"(#version 450 core
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler3D densities;
layout(std430, binding = 0) writeonly buffer Picture { float alpha[]; };
uniform vec3 eye;  // relative to the low corner of the grid, in units of its side
uniform vec3 forward;
uniform vec3 right;
uniform vec3 up;
uniform ivec2 size;
uniform int voxels;
uniform float extinction;  // per side of the grid

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    const vec2 place = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 way = normalize(forward + place.x * right - place.y * up);
    way = mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));
    const vec3 a = -eye / way;
    const vec3 b = (1.0 - eye) / way;
    const vec3 enter = min(a, b);
    const vec3 leave = max(a, b);
    const float first = max(max(max(enter.x, enter.y), enter.z), 0.0);
    const float last = min(min(leave.x, leave.y), leave.z);
    const float stride = 0.5 / float(voxels);
    const int steps = clamp(int(ceil((last - first) / stride)), 0, 4 * voxels);
    float through = 1.0;
    for (int i = 0; i < steps && through > 0.01; ++i) {
        const vec3 at = eye + way * (first + (float(i) + 0.5) * stride);
        through *= exp(-extinction * stride * textureLod(densities, at, 0.0).r);
    }
    alpha[pixel.y * size.x + pixel.x] = 1.0 - through;
}
)";

gl::Program build_program() {
    const gl::ShaderHandle shader(glCreateShader(GL_COMPUTE_SHADER));
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    gl::ProgramHandle program(glCreateProgram());
    glAttachShader(program.id(), shader.id());
    glLinkProgram(program.id());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) throw Error(Fault::context, "bench", "the regular grid's program did not link");
    return gl::Program(std::move(program));
}

}  // namespace

RegularGrid::RegularGrid(const renderer::Field& field, double extinction)
    : frame_(field.frame()), extinction_(extinction), program_(build_program()) {
    const auto side = int(frame_.size.x);
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &id);
    densities_ = gl::TextureHandle(id);
    glTextureStorage3D(id, 1, GL_R8, side, side, side);
    if (glGetError() == GL_OUT_OF_MEMORY)
        throw Error(Fault::memory, "bench", "the regular grid does not fit", "choose fewer voxels");
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(id, axis, GL_CLAMP_TO_BORDER);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    constexpr int slab = 16;
    const std::size_t area = std::size_t(side) * std::size_t(side);
    std::vector<std::uint8_t> texels(area * slab);
    for (int low = 0; low < side; low += slab) {
        const int count = std::min(slab, side - low);
        tbb::parallel_for(0, count, [&](int z) {
            std::vector<float> values(area);
            field.fill(0, {0, 0, low + z}, {side, side, 1}, values.data());
            std::transform(values.begin(), values.end(), texels.begin() + std::ptrdiff_t(area) * z,
                           [](float v) { return std::uint8_t(std::lround(255.0F * v)); });
        });
        glTextureSubImage3D(id, 0, 0, 0, low, side, side, count, GL_RED, GL_UNSIGNED_BYTE, texels.data());
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

RegularGrid::Result RegularGrid::march(const renderer::View& view) const {
    const std::size_t pixels = std::size_t(view.size.width) * std::size_t(view.size.height);
    const gl::Buffer picture(pixels * sizeof(float), "picture");
    const double side = frame_.voxel_size * double(frame_.size.x);
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const double half_height = std::tan(0.5 * view.camera.yfov);
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    program_.use();
    program_.set("eye", glm::vec3((view.camera.eye - frame_.origin) / side));
    program_.set("forward", glm::vec3(forward));
    program_.set("right", glm::vec3(right * (half_height * view.size.width / view.size.height)));
    program_.set("up", glm::vec3(glm::cross(right, forward) * half_height));
    program_.set("size", glm::ivec2(view.size.width, view.size.height));
    program_.set("voxels", int(frame_.size.x));
    program_.set("extinction", float(extinction_ * side));
    glBindTextureUnit(0, densities_.id());
    picture.bind_storage(0);
    glDispatchCompute((unsigned(view.size.width) + group_side - 1) / group_side,
                      (unsigned(view.size.height) + group_side - 1) / group_side, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();
    Result result;
    result.milliseconds = milliseconds_since(start);
    result.alpha = picture.read_all<float>(pixels);
    return result;
}

}  // namespace cairn::bench
