#include "renderer/produce/surface_producer.h"

#include <algorithm>
#include <bit>

#include "renderer/produce/tile_lists.h"
#include "shaders/interop/bindings.h"

namespace cairn::renderer {
namespace {

constexpr std::size_t scratch_budget_bytes = std::size_t(24) << 20U;
/// Pairs sent to the driver at once.
constexpr std::size_t pair_capacity = std::size_t(1) << 18U;
/// A triangle that crosses a whole brick is cut in pieces, for threads to share and because no thread may
/// turn its loops too often (docs/decisions.md). A voxel takes a turn for itself, 16 for its rows, and 64
/// more for an alpha mask.
constexpr int turns_a_pair = 30000;
constexpr unsigned group_size = 64;

std::size_t scratch_bytes_a_brick(const TreeShape& shape, bool has_color) {
    const auto side = std::size_t(shape.m) + 2;
    return side * side * side * (has_color ? 9 : 6) * sizeof(std::uint32_t);  // 2 mask words and SUM_WORDS
}

/// The rows that lattice coordinates lie in, of voxels of that side: rounded down.
glm::ivec2 row_of(const glm::ivec2& place, int voxel) {
    const glm::ivec2 cut = place / voxel;
    return cut - glm::ivec2(glm::lessThan(place, cut * voxel));
}

}  // namespace

SurfaceProducer::SurfaceProducer(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                                 voxelizer::TriangleIndex& lists, const gl::ShaderSource& shaders)
    : shape_(shape),
      surface_(surface),
      lists_(lists),
      tell_empty_(shape.cell_base() != 2 || surface.has_mask),
      pairs_(surface.chunks.size()) {
    const std::size_t brick_bytes = scratch_bytes_a_brick(shape, surface.has_color);
    batch_ = int(std::clamp<std::size_t>(scratch_budget_bytes / brick_bytes, 1, 0xFFFF));
    gl::Defines defines = shape.defines(surface.has_color);
    masks_ = gl::build_compute(shaders, "produce/masks.comp.glsl", defines);
    resolve_ = gl::build_compute(shaders, "produce/resolve.comp.glsl", defines);
    defines.emplace_back("TELL_EMPTY", tell_empty_ ? "1" : "0");
    summarize_ = gl::build_compute(shaders, "produce/summarize.comp.glsl", defines);
    defines.emplace_back("HAS_MASK", surface.has_mask ? "1" : "0");
    splat_ = gl::build_compute(shaders, "produce/splat.comp.glsl", defines);

    scratch_ = gl::Buffer(std::size_t(batch_) * brick_bytes, "brick scratch");
    scratch_.fill(0);
    // Masks of all voxels of a batch stand before their sums (scratch.glsl).
    const std::size_t side = std::size_t(shape.m) + 2;
    for (gl::Program* program : {&splat_, &resolve_})
        program->set("sums_offset", unsigned(std::size_t(batch_) * side * side * side * 2));
    tiles_ = gl::Buffer(std::size_t(batch_) * sizeof(interop::BrickTile), "brick tiles");
    if (tell_empty_)
        found_ = gl::Buffer(std::size_t(batch_) * sizeof(std::uint32_t), "bricks that hold anything");
    pair_buffer_ = gl::Buffer(pair_capacity * sizeof(interop::BrickPair), "brick pairs");
}

std::vector<Produced> SurfaceProducer::produce(std::span<const BrickRequest> requests,
                                               const BrickPool& pool) {
    std::vector<Produced> produced(requests.size());
    for (std::size_t i = 0; i < requests.size(); i += std::size_t(batch_)) {
        const std::size_t count = std::min(std::size_t(batch_), requests.size() - i);
        produce_batch(requests.subspan(i, count), pool);
        if (!tell_empty_) continue;
        const auto found = found_.read_all<std::uint32_t>(count);
        for (std::size_t k = 0; k < count; ++k)
            produced[i + k].constant = found[k] == 0;
    }
    return produced;
}

void SurfaceProducer::gather_pairs(std::span<const BrickRequest> requests) {
    for (auto& list : pairs_)
        list.clear();
    const int side = shape_.m + 2;
    const int rows = std::max(1, turns_a_pair / (side * (surface_.has_mask ? 81 : 17)));
    const glm::ivec2 step(std::min(rows, side), std::max(1, rows / side));  // of y, of z
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const Tile& tile = requests[i].tile;
        const int voxel = shape_.voxel_side(tile.level);
        const glm::ivec2 low = glm::ivec2(tile.position.y, tile.position.z) * shape_.m - 1;  // of the border
        for (const std::uint32_t triangle : triangles_of(tile, shape_, lists_, listed_)) {
            // Row r is touched when [r, r + 1] meets the triangle's extent: one more on each side of whole
            // numbers.
            const voxelizer::TriangleIndex::Box& box = lists_.box(triangle);
            const glm::ivec2 first = glm::max(row_of({box.low.y - 1, box.low.z - 1}, voxel) - low, 0);
            const glm::ivec2 last = glm::min(row_of({box.high.y, box.high.z}, voxel) - low, shape_.m + 1);
            for (int z = first.y; z <= last.y; z += step.y) {
                for (int y = first.x; y <= last.x; y += step.x) {
                    const auto y_count = std::uint32_t(std::min(step.x, last.x - y + 1));
                    const auto z_count = std::uint32_t(std::min(step.y, last.y - z + 1));
                    pairs_[triangle / SURFACE_CHUNK_TRIANGLES].push_back(
                        {triangle % SURFACE_CHUNK_TRIANGLES, std::uint32_t(i),
                         std::uint32_t(y) | y_count << 8U | std::uint32_t(z) << 16U | z_count << 24U});
                }
            }
        }
    }
}

void SurfaceProducer::splat(std::size_t chunk) {
    const std::vector<interop::BrickPair>& pairs = pairs_[chunk];
    if (pairs.empty()) return;
    surface_.bind(chunk);
    tiles_.bind_storage(SSBO_BRICK_TILES);
    scratch_.bind_storage(SSBO_BRICK_SCRATCH);
    pair_buffer_.bind_storage(SSBO_BRICK_PAIRS);
    splat_.use();
    for (std::size_t i = 0; i < pairs.size(); i += pair_capacity) {
        const std::size_t count = std::min(pair_capacity, pairs.size() - i);
        pair_buffer_.write(0, &pairs[i], count * sizeof(interop::BrickPair));
        splat_.set("pair_count", unsigned(count));
        gl::dispatch_threads(count, group_size);
    }
}

void SurfaceProducer::produce_batch(std::span<const BrickRequest> requests, const BrickPool& pool) {
    std::vector<interop::BrickTile> tiles;
    tiles.reserve(requests.size());
    for (const BrickRequest& request : requests) {
        const int side = shape_.voxel_side(request.tile.level);
        const int size = shape_.cell_base() == 2 ? int(std::bit_width(unsigned(side))) - 1 : side;
        tiles.push_back({glm::ivec4(glm::ivec3(request.tile.position) * shape_.m, size),
                         glm::ivec4(pool.first_texel(request.slot), request.slot)});
    }
    tiles_.write(0, tiles.data(), tiles.size() * sizeof(interop::BrickTile));

    gather_pairs(requests);
    for (std::size_t chunk = 0; chunk < pairs_.size(); ++chunk)
        splat(chunk);

    pack(requests.size(), pool);
}

/// Turns what was gathered for the batch into bricks.
void SurfaceProducer::pack(std::size_t tile_count, const BrickPool& pool) {
    const auto count = unsigned(tile_count);
    const auto blocks = std::size_t(shape_.blocks());
    const auto side = std::size_t(shape_.m) + 2;
    tiles_.bind_storage(SSBO_BRICK_TILES);
    scratch_.bind_storage(SSBO_BRICK_SCRATCH);
    pool.bind_for_writing();
    if (tell_empty_) {
        found_.fill(0);
        found_.bind_storage(SSBO_BRICK_FOUND);
    }
    auto run = [&](const gl::Program& program, std::size_t threads) {
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        program.use();
        program.set("tile_count", count);
        gl::dispatch_threads(threads, group_size);
    };
    run(masks_, count * blocks);
    run(summarize_, count * ((blocks + 63) / 64));
    glMemoryBarrier(
        GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);  // rays of an earlier pass may still read evicted slots
    run(resolve_, count * side * side * side);
    // The next batch reuses the scratch; rays fetch the texels.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace cairn::renderer
