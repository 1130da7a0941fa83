#include "renderer/shadow/column_pyramid.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <string>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/error.h"
#include "gl/buffer_texture.h"
#include "gl/limits.h"
#include "shaders/interop/columns.h"
#include "shaders/interop/threads.h"

namespace cairn::renderer {
namespace {

constexpr std::size_t texel_bytes = COLUMN_TEXEL_BITS / 8;

int levels_of(int resolution) {
    if (resolution < 1 << COLUMN_LEAST_LEVELS || resolution > 1 << COLUMN_MOST_LEVELS ||
        !std::has_single_bit(unsigned(resolution))) {
        throw Error(Fault::usage, "pyramid", fmt::format("{} voxels per side", resolution),
                    fmt::format("choose a power of two from {} to {}", 1 << COLUMN_LEAST_LEVELS,
                                1 << COLUMN_MOST_LEVELS));
    }
    return std::countr_zero(unsigned(resolution));
}

std::size_t column_texels(int levels) {
    return (std::size_t(1) << levels) <= COLUMN_TEXEL_BITS ? 1
                                                           : (std::size_t(1) << levels) / COLUMN_TEXEL_BITS;
}

std::size_t texels_of_level(int levels, int level) {
    return column_texels(levels) << (2 * (levels - level));
}

std::size_t checked_bytes(int levels) {
    std::size_t texels = 0;
    for (int level = 0; level <= levels; ++level)
        texels += texels_of_level(levels, level);
    const gl::Limits limits = gl::query_limits();
    const std::size_t coarse = texels - texels_of_level(levels, 0);
    // All texels are fetched; those of coarser levels are written as storage too.
    if (texels > limits.texture_buffer_texels || coarse * texel_bytes > limits.shader_storage_bytes) {
        throw Error(Fault::memory, "pyramid",
                    fmt::format("{} voxels per side take {} MiB, more than a shader of this driver can see",
                                1 << levels, texels * texel_bytes >> 20U),
                    "choose half the resolution");
    }
    return texels * texel_bytes;
}

}  // namespace

ColumnPyramid::ColumnPyramid(int resolution, const gl::ShaderSource& shaders)
    : levels_(levels_of(resolution)),
      halve_(gl::build_compute(shaders, "shadow/halve_columns.comp.glsl",
                               {{"COLUMN_LEVELS", std::to_string(levels_)}})),
      texels_(checked_bytes(levels_), "pyramid of columns") {
    texture_ = gl::buffer_texture(GL_RGBA32UI, texels_);
}

glm::ivec3 ColumnPyramid::grid_size() const {
    return {std::max(resolution(), COLUMN_TEXEL_BITS), resolution(), resolution()};
}

gl::Defines ColumnPyramid::defines() const {
    return {{"COLUMN_LEVELS", std::to_string(levels_)}};
}

void ColumnPyramid::bind_for_reading() const {
    glBindTextureUnit(TEXTURE_COLUMNS, texture_.id());
}

void ColumnPyramid::build(const gl::Buffer& bits) {
    const std::size_t finest_bytes = texels_of_level(levels_, 0) * texel_bytes;
    if (bits.size_bytes() < finest_bytes)
        throw Error(Fault::internal, "pyramid", "it is given fewer bits than it has voxels");
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(bits.id(), texels_.id(), 0, 0, GLsizeiptr(finest_bytes));
    bind_for_reading();
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, SSBO_COLUMNS, texels_.id(), GLintptr(finest_bytes),
                      GLsizeiptr(texels_.size_bytes() - finest_bytes));
    for (int level = 1; level <= levels_; ++level) {
        halve_.set("level", level);
        halve_.use();
        gl::dispatch_threads(texels_of_level(levels_, level), THREADS_PER_GROUP);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();
    last_milliseconds_ = milliseconds_since(start);
}

}  // namespace cairn::renderer
