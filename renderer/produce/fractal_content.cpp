#include "renderer/produce/fractal_content.h"

#include <algorithm>

#include "renderer/pool/brick_pool.h"
#include "shaders/interop/produce.h"
#include "shaders/interop/threads.h"

namespace cairn::renderer {
namespace {

bool is_occupied(const Tile& tile, const TreeShape& shape) {
    return shape.n == 3 ? sponge::occupied(tile.position, tile.level)
                        : fractal::occupied(tile.position, shape.n_shift() * tile.level);
}

/// Bit x + 3 (y + 3 z): may voxels of the tile at (x, y, z) - 1 from this one be occupied?
std::uint32_t neighbour_mask(const Tile& tile, const TreeShape& shape) {
    std::uint32_t mask = 0;
    for (int number = 0; number < 27; ++number) {
        const glm::i64vec3 step(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1);
        if (is_occupied({tile.level, tile.position + step}, shape)) mask |= 1U << unsigned(number);
    }
    return mask;
}

/// Resolution of the grid. If rays go through windows, no caller asks for the finest voxels.
int grid_resolution(const TreeShape& shape) {
    return shape.has_windows() ? shape.m : shape.resolution();
}

}  // namespace

bool sponge::occupied(const glm::i64vec3& position, int level) {
    glm::i64vec3 rest = position;
    for (int digit = 0; digit < level; ++digit) {
        const glm::bvec3 in_middle = glm::equal(rest % std::int64_t(3), glm::i64vec3(1));
        if (int(in_middle.x) + int(in_middle.y) + int(in_middle.z) > 1) return false;
        rest /= std::int64_t(3);
    }
    return rest == glm::i64vec3(0) && glm::all(glm::greaterThanEqual(position, glm::i64vec3(0)));
}

glm::uvec2 FractalOracle::child_mask(const Tile& tile) {
    glm::uvec2 mask(0);
    for (int child = 0; child < shape_.child_count(); ++child) {
        const Tile inner = child_of(tile, shape_.n, child);
        if (is_occupied(inner, shape_)) mask[child / 32] |= 1U << unsigned(child % 32);
    }
    return mask;
}

FractalProducer::FractalProducer(const TreeShape& shape, const gl::ShaderSource& shaders, std::size_t batch)
    : shape_(shape),
      batch_(std::max<std::size_t>(batch, 1)),
      texels_(gl::build_compute(shaders, "produce/fractal.comp.glsl", shape.defines(false))),
      masks_(gl::build_compute(shaders, "produce/fractal_masks.comp.glsl", shape.defines(false))),
      tiles_(batch_ * sizeof(interop::FractalTile), "fractal tiles") {}

std::vector<ProducedTile> FractalProducer::produce(std::span<const BrickRequest> requests, BrickPool& pool) {
    const auto side = std::size_t(shape_.m) + 2;
    const auto words = std::size_t(shape_.mask_words());
    for (std::size_t first = 0; first < requests.size(); first += batch_) {
        const std::size_t count = std::min(batch_, requests.size() - first);
        std::vector<interop::FractalTile> tiles;
        for (const BrickRequest& request : requests.subspan(first, count)) {
            interop::FractalTile& tile = tiles.emplace_back();
            tile.first_texel = pool.first_texel(request.slot);
            tile.slot = request.slot;
            tile.neighbours = neighbour_mask(request.tile, shape_);
        }
        tiles_.write(0, tiles.data(), tiles.size() * sizeof(interop::FractalTile));
        tiles_.bind_storage(SSBO_BRICK_TILES);
        pool.bind_for_writing();
        // Rays of an earlier pass may still read evicted slots.
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        auto dispatch = [&](const gl::Program& program, std::size_t threads) {
            program.use();
            program.set("tile_count", unsigned(count));
            gl::dispatch_threads(threads, THREADS_PER_GROUP);
        };
        dispatch(texels_, count * side * side * side);
        dispatch(masks_, count * words);
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    return std::vector<ProducedTile>(requests.size());
}

FractalContent::FractalContent(const TreeShape& shape, const gl::ShaderSource& shaders)
    : shape_(shape), oracle_(shape), producer_(shape, shaders) {
    grid_.resolution = glm::ivec3(grid_resolution(shape));
    grid_.voxel_size = 1.0 / grid_.resolution.x;
}

}  // namespace cairn::renderer
