#include "voxelizer/methods/pyramid_builder.h"

#include <algorithm>
#include <chrono>

#include "base/clock.h"
#include "shaders/interop/threads.h"
#include "shaders/interop/voxelize.h"

namespace cairn::voxelizer {
namespace {

/// Rows of so many words are read four words at a time.
bool is_wide(const glm::ivec3& size) {
    return (size.x + 31) / 32 % 4 == 0;
}

gl::TextureHandle buffer_texture() {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
    return gl::TextureHandle(id);
}

void show(const gl::TextureHandle& texture, const gl::Buffer& bits, const glm::ivec3& size) {
    glTextureBuffer(texture.id(), is_wide(size) ? GL_RGBA32UI : GL_R32UI, bits.id());
}

}  // namespace

std::size_t bit_bytes(const glm::ivec3& size) {
    return std::size_t((size.x + 31) / 32) * std::size_t(size.y) * std::size_t(size.z) *
           sizeof(std::uint32_t);
}

BitGrid read_bits(const gl::Buffer& bits, const glm::ivec3& size) {
    BitGrid out(size);
    bits.read(0, out.words.data(), out.words.size() * sizeof(std::uint32_t));
    return out;
}

PyramidBuilder::PyramidBuilder(const gl::ShaderSource& shaders)
    : halve_([shaders](const HalveVariant& variant) {
          return gl::build_compute(shaders, "voxelize/halve.comp.glsl",
                                   {{"WIDE", variant.is_wide ? "1" : "0"}});
      }),
      finest_(buffer_texture()) {
    // Now, so that no time that is measured has their compilation in it.
    (void)halve_.get({.is_wide = true});
    (void)halve_.get({.is_wide = false});
}

void PyramidBuilder::prepare(const glm::ivec3& size, Reduction reduction) {
    if (size == finest_size_ && reduction == reduction_) return;
    levels_.clear();
    finest_size_ = size;
    reduction_ = reduction;
    glm::ivec3 half = coarser_size(size, reduction);
    for (glm::ivec3 fine = size; fine != half; half = coarser_size(fine, reduction)) {
        Level level;
        level.size = half;
        level.bits = gl::Buffer(std::max<std::size_t>(bit_bytes(level.size), 16), "voxel pyramid");
        level.texture = buffer_texture();
        show(level.texture, level.bits, level.size);
        fine = level.size;
        levels_.push_back(std::move(level));
    }
}

void PyramidBuilder::halve(const gl::TextureHandle& fine, const glm::ivec3& fine_size, const Level& coarse) {
    const gl::Program& program = halve_.get({is_wide(fine_size)});
    glBindTextureUnit(TEXTURE_HALVE_FINE, fine.id());
    coarse.bits.bind_storage(SSBO_HALVE_COARSE);
    program.set("fine_size", fine_size);
    program.set("coarse_size", coarse.size);
    program.use();
    const int coarse_words = (coarse.size.x + 31) / 32;
    gl::dispatch_threads(
        std::size_t((coarse_words + 1) / 2) * std::size_t(coarse.size.y) * std::size_t(coarse.size.z),
        THREADS_PER_GROUP);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

BitmaskPyramid PyramidBuilder::build(const gl::Buffer& bits, const glm::ivec3& size, Reduction reduction) {
    prepare(size, reduction);
    show(finest_, bits, size);
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    const gl::TextureHandle* fine = &finest_;
    glm::ivec3 fine_size = size;
    for (const Level& level : levels_) {
        halve(*fine, fine_size, level);
        fine = &level.texture;
        fine_size = level.size;
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();
    last_milliseconds_ = milliseconds_since(start);
    std::vector<BitGrid> levels;
    levels.push_back(read_bits(bits, size));
    for (const Level& level : levels_)
        levels.push_back(read_bits(level.bits, level.size));
    return BitmaskPyramid(std::move(levels));
}

}  // namespace cairn::voxelizer
