#include "voxelizer/pyramid_builder.h"

#include <algorithm>
#include <chrono>

#include "shaders/interop/bindings.h"
#include "shaders/interop/config.h"

namespace cairn::voxelizer {

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
    : halve_(gl::build_compute(shaders, "voxelize/halve.comp.glsl")) {}

BitmaskPyramid PyramidBuilder::build(const gl::Buffer& bits, const glm::ivec3& size) {
    std::vector<BitGrid> levels;
    levels.push_back(read_bits(bits, size));
    last_milliseconds_ = 0.0;
    const gl::Buffer* fine = &bits;
    std::array<gl::Buffer, 2> coarse;
    for (glm::ivec3 fine_size = size; fine_size != glm::ivec3(1);) {
        const glm::ivec3 half = (fine_size + 1) / 2;
        gl::Buffer& out = coarse[levels.size() % 2];
        out = gl::Buffer(std::max<std::size_t>(bit_bytes(half), 16), "voxel pyramid");
        glFinish();
        const auto start = std::chrono::steady_clock::now();
        fine->bind_storage(SSBO_HALVE_FINE);
        out.bind_storage(SSBO_HALVE_COARSE);
        halve_.set("fine_size", fine_size);
        halve_.use();
        gl::dispatch_threads(bit_bytes(half) / sizeof(std::uint32_t), VOXEL_GROUP);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        glFinish();
        last_milliseconds_ +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        levels.push_back(read_bits(out, half));
        fine = &out;
        fine_size = half;
    }
    return BitmaskPyramid(std::move(levels));
}

}  // namespace cairn::voxelizer
