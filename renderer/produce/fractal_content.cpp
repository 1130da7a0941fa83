#include "renderer/produce/fractal_content.h"

#include <algorithm>

#include "shaders/interop/bindings.h"
#include "shaders/interop/types.h"

namespace cairn::renderer {
namespace {

constexpr std::size_t batch = 1024;
constexpr unsigned group_size = 64;

}  // namespace

std::uint32_t fractal::neighbour_mask(const Tile& tile, int n_shift) {
    std::uint32_t mask = 0;
    for (int number = 0; number < 27; ++number) {
        const glm::i64vec3 step(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1);
        if (occupied(tile.position + step, n_shift * tile.level)) mask |= 1U << unsigned(number);
    }
    return mask;
}

glm::uvec2 FractalOracle::child_mask(const Tile& tile) {
    glm::uvec2 mask(0);
    for (int child = 0; child < shape_.child_count(); ++child) {
        const Tile inner = child_of(tile, shape_.n, child);
        if (fractal::occupied(inner.position, shape_.n_shift() * inner.level))
            mask[child / 32] |= 1U << unsigned(child % 32);
    }
    return mask;
}

FractalProducer::FractalProducer(const TreeShape& shape, const gl::ShaderSource& shaders)
    : shape_(shape),
      texels_(gl::build_compute(shaders, "produce/fractal.comp.glsl", shape.defines(false))),
      masks_(gl::build_compute(shaders, "produce/fractal_masks.comp.glsl", shape.defines(false))),
      tiles_(batch * sizeof(interop::FractalTile), "fractal tiles") {}

std::vector<Produced> FractalProducer::produce(std::span<const BrickRequest> requests,
                                               const BrickPool& pool) {
    const auto side = std::size_t(shape_.m) + 2;
    const auto blocks = std::size_t(shape_.m / 4) * std::size_t(shape_.m / 4) * std::size_t(shape_.m / 4);
    const std::size_t words = blocks + (blocks + 63) / 64;
    for (std::size_t first = 0; first < requests.size(); first += batch) {
        const std::size_t count = std::min(batch, requests.size() - first);
        std::vector<interop::FractalTile> tiles;
        for (const BrickRequest& request : requests.subspan(first, count)) {
            tiles.push_back({glm::ivec4(pool.first_texel(request.slot), request.slot),
                             glm::uvec4(fractal::neighbour_mask(request.tile, shape_.n_shift()), 0, 0, 0)});
        }
        tiles_.write(0, tiles.data(), tiles.size() * sizeof(interop::FractalTile));
        tiles_.bind_storage(SSBO_BRICK_TILES);
        pool.bind_for_writing();
        // Rays of an earlier pass may still read evicted slots.
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        auto run = [&](const gl::Program& program, std::size_t threads) {
            program.use();
            program.set("tile_count", unsigned(count));
            gl::dispatch_threads(threads, group_size);
        };
        run(texels_, count * side * side * side);
        run(masks_, count * words);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    return std::vector<Produced>(requests.size());
}

FractalContent::FractalContent(const TreeShape& shape, const gl::ShaderSource& shaders)
    : oracle_(shape), producer_(shape, shaders) {
    const int bits = shape.has_windows() ? shape.m_shift() : shape.voxel_level(shape.max_level);
    grid_.resolution = glm::ivec3(1 << bits);
    grid_.voxel_size = 1.0 / double(1 << bits);
}

}  // namespace cairn::renderer
