#include "renderer/produce/surface_producer.h"

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/produce/tile_lists.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"

namespace cairn::renderer {
namespace {

/// Loop turns of a thread at most. A triangle that crosses a whole brick is cut in pieces, which threads
/// share, because no thread may turn its loops too often (docs/decisions/house_and_scenes.md).
constexpr int turns_per_pair = 30000;
/// A voxel takes a turn itself, and at most one to find its row, two for the row's span and four for its
/// bounds; 64 more for an alpha mask; and for a texture up to 5 means, each over the way to its mip level and
/// the 4 texels of up to 8 boxes.
constexpr int turns_of_voxel = 8;
constexpr int turns_of_mask = 64;
constexpr int turns_of_texture = 5 * (1 + 14 + 8 * 5);

/// Voxels of all mips of a brick, border included.
std::size_t voxels_per_brick(const TreeShape& shape) {
    std::size_t voxels = 0;
    for (int mip = 0; mip <= shape.mips; ++mip) {
        const auto side = std::size_t(shape.mip_side(mip));
        voxels += side * side * side;
    }
    return voxels;
}

/// What a thread leaves of each record for those behind it (records.glsl): at most of all voxels of a brick.
std::size_t record_bytes_per_brick(const TreeShape& shape) {
    return voxels_per_brick(shape) * 2 * sizeof(std::uint32_t);
}

/// Entries of the table of marks, of all voxels of a brick.
std::size_t table_bytes_per_brick(const TreeShape& shape) {
    return (voxels_per_brick(shape) / 32 + 2) * 2 * sizeof(std::uint32_t);
}

std::size_t scratch_bytes_per_brick(const TreeShape& shape, bool has_color) {
    return voxels_per_brick(shape) * (has_color ? 14 : 11) *
           sizeof(std::uint32_t);  // 2 mask words and SUM_WORDS
}

/// The voxel, of side `voxel`, that lattice coordinates lie in: rounded down.
glm::ivec3 voxel_of(const glm::ivec3& place, int voxel) {
    const glm::ivec3 cut = place / voxel;
    return cut - glm::ivec3(glm::lessThan(place, cut * voxel));
}

}  // namespace

SurfaceProducer::SurfaceProducer(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                                 voxelizer::TriangleIndex& lists, const gl::ShaderSource& shaders,
                                 const SurfaceProducerLimits& limits)
    : shape_(shape),
      surface_(surface),
      lists_(lists),
      pair_room_(std::max<std::size_t>(limits.pairs, 1)),
      pairs_(surface.chunks.size()) {
    const std::size_t brick_bytes = scratch_bytes_per_brick(shape, surface.has_color);
    const std::size_t batch_bytes =
        brick_bytes + record_bytes_per_brick(shape) + table_bytes_per_brick(shape);
    batch_ = int(std::clamp<std::size_t>(limits.scratch_bytes / batch_bytes, 1, 0xFFFF));
    gl::Defines defines = shape.defines(surface.has_color);
    defines.emplace_back("HAS_MASK", surface.has_mask ? "1" : "0");
    resolve_ = gl::build_compute(shaders, "produce/resolve.comp.glsl", defines);
    border_masks_ = gl::build_compute(shaders, "produce/border_masks.comp.glsl", defines);
    count_records_ = gl::build_compute(shaders, "produce/count_records.comp.glsl", defines);
    store_heads_ = gl::build_compute(shaders, "produce/store_heads.comp.glsl", defines);
    masks_ = gl::build_compute(shaders, "produce/masks.comp.glsl", defines);
    summarize_ = gl::build_compute(shaders, "produce/summarize.comp.glsl", defines);
    splat_ = gl::build_compute(shaders, "produce/splat.comp.glsl", defines);
    normals_ = gl::build_compute(shaders, "produce/normals.comp.glsl", defines);
    if (has_slabs()) slabs_ = gl::build_compute(shaders, "produce/slabs.comp.glsl", defines);
    flat_voxels_ = gl::build_compute(shaders, "produce/flat_voxels.comp.glsl", defines);
    count_marks_ = gl::build_compute(shaders, "produce/count_marks.comp.glsl", defines);

    scratch_ = gl::Buffer(std::size_t(batch_) * brick_bytes, "brick scratch");
    scratch_.fill(0);
    // The masks of all voxels of a batch stand before the sums (scratch.glsl).
    for (gl::Program* program : {&splat_, &normals_, &slabs_, &flat_voxels_, &resolve_}) {
        if (program->id() != 0)
            program->set("sums_offset", unsigned(std::size_t(batch_) * voxels_per_brick(shape) * 2));
    }
    tiles_ = gl::Buffer(std::size_t(batch_) * sizeof(interop::BrickTile), "brick tiles");
    heads_ = gl::Buffer(std::size_t(batch_) * std::size_t(shape.head_words()) * sizeof(std::uint32_t),
                        "heads of bricks");
    marked_ = gl::Buffer(std::size_t(batch_) * table_bytes_per_brick(shape), "marked records");
    record_places_ = gl::Buffer(std::size_t(batch_) * record_bytes_per_brick(shape), "places of records");
    counts_ = gl::Buffer(std::size_t(batch_) * sizeof(interop::PackedCount), "counts of records");
    pair_buffer_ = gl::Buffer(pair_room_ * sizeof(interop::BrickPair), "brick pairs");
}

std::vector<ProducedTile> SurfaceProducer::produce(std::span<const BrickRequest> requests, BrickPool& pool) {
    if (pool.packed() == nullptr)
        throw Error(Fault::internal, "brick pool", "the bricks of a surface in a pool of dense bricks");
    std::vector<ProducedTile> produced(requests.size());
    for (std::size_t i = 0; i < requests.size(); i += std::size_t(batch_)) {
        const std::size_t count = std::min(std::size_t(batch_), requests.size() - i);
        produce_batch(requests.subspan(i, count), pool, std::span(produced).subspan(i, count));
    }
    return produced;
}

void SurfaceProducer::gather_pairs(std::span<const BrickRequest> requests) {
    for (auto& list : pairs_)
        list.clear();
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const Tile& tile = requests[i].tile;
        const std::span<const std::uint32_t> triangles = triangles_of(tile, shape_, lists_, listed_);
        for (int mip = 0; mip <= shape_.mips; ++mip)
            gather_pairs_of_mip(tile, std::uint32_t(i), mip, triangles);
    }
}

void SurfaceProducer::gather_pairs_of_mip(const Tile& tile, std::uint32_t number, int mip,
                                          std::span<const std::uint32_t> triangles) {
    const int side = shape_.mip_side(mip);
    const int turns = turns_of_voxel + (surface_.has_mask ? turns_of_mask : 0) +
                      (surface_.has_color && surface_.has_texture ? turns_of_texture : 0);
    const int rows = std::clamp(turns_per_pair / (side * turns), 1, PAIR_MOST_ROWS);
    const glm::ivec2 step(std::min(rows, side), std::max(1, rows / side));  // of y, of z
    const int voxel = shape_.voxel_side(tile.level) << mip;
    const glm::ivec3 low = glm::ivec3(tile.position) * (shape_.m >> mip) - 1;  // of the border
    for (const std::uint32_t triangle : triangles) {
        // Row r is touched when [r, r + 1] meets the triangle's extent: one more on each side of whole
        // numbers.
        const voxelizer::TriangleIndex::Box& box = lists_.box(triangle);
        const glm::ivec3 first = glm::max(voxel_of(box.low - 1, voxel) - low, 0);
        const glm::ivec3 last = glm::min(voxel_of(box.high, voxel) - low, side - 1);
        if (first.x > last.x) continue;  // near the border of a coarser mip alone
        for (int z = first.z; z <= last.z; z += step.y) {
            for (int y = first.y; y <= last.y; y += step.x) {
                const auto y_count = std::uint32_t(std::min(step.x, last.y - y + 1));
                const auto z_count = std::uint32_t(std::min(step.y, last.z - z + 1));
                pairs_[triangle / surface_.chunk_triangles].push_back(
                    {triangle % surface_.chunk_triangles, number | std::uint32_t(mip) << 16U,
                     std::uint32_t(y) | y_count << 8U | std::uint32_t(z) << 16U | z_count << 24U});
            }
        }
    }
}

/// Runs a program of which a thread is a pair.
void SurfaceProducer::run_pairs(gl::Program& program, std::size_t chunk) {
    const std::vector<interop::BrickPair>& pairs = pairs_[chunk];
    if (pairs.empty()) return;
    surface_.bind(chunk);
    tiles_.bind_storage(SSBO_BRICK_TILES);
    scratch_.bind_storage(SSBO_BRICK_SCRATCH);
    pair_buffer_.bind_storage(SSBO_BRICK_PAIRS);
    program.use();
    for (std::size_t i = 0; i < pairs.size(); i += pair_room_) {
        const std::size_t count = std::min(pair_room_, pairs.size() - i);
        pair_buffer_.write(0, &pairs[i], count * sizeof(interop::BrickPair));
        program.set("pair_count", unsigned(count));
        gl::dispatch_threads(count, THREADS_PER_GROUP);
    }
}

void SurfaceProducer::produce_batch(std::span<const BrickRequest> requests, BrickPool& pool,
                                    std::span<ProducedTile> produced) {
    batch_tiles_.clear();
    for (const BrickRequest& request : requests) {
        const int side = shape_.voxel_side(request.tile.level);
        const int size = shape_.cell_base() == 2 ? int(std::bit_width(unsigned(side))) - 1 : side;
        interop::BrickTile& tile = batch_tiles_.emplace_back();
        tile.low = glm::ivec3(request.tile.position) * shape_.m;
        tile.size = size;
        tile.first_word = NO_ROOM;
    }
    tiles_.write(0, batch_tiles_.data(), batch_tiles_.size() * sizeof(interop::BrickTile));

    gather_pairs(requests);
    for (std::size_t chunk = 0; chunk < pairs_.size(); ++chunk)
        run_pairs(splat_, chunk);

    number_records(requests.size());
    find_slabs(requests.size());
    find_room(requests, pool, produced);
    pack(requests.size(), pool);
}

void SurfaceProducer::dispatch(gl::Program& program, std::size_t tile_count, std::size_t threads) const {
    if (threads == 0) return;
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program.use();
    program.set("tile_count", unsigned(tile_count));
    gl::dispatch_threads(threads, THREADS_PER_GROUP);
}

/// Makes the heads of the batch's bricks, and counts what they need.
void SurfaceProducer::number_records(std::size_t tile_count) {
    tiles_.bind_storage(SSBO_BRICK_TILES);
    scratch_.bind_storage(SSBO_BRICK_SCRATCH);
    heads_.bind_storage(SSBO_BRICK_HEADS);
    counts_.bind_storage(SSBO_BRICK_COUNTS);
    for (int mip = 0; mip <= shape_.mips; ++mip) {
        masks_.set("mip", mip);
        dispatch(masks_, tile_count, tile_count * std::size_t(shape_.blocks(mip)));
    }
    dispatch(border_masks_, tile_count, tile_count * std::size_t(shape_.groups() - shape_.inner_groups()));
    dispatch(summarize_, tile_count, tile_count * std::size_t(shape_.summary_words()));
    dispatch(count_records_, tile_count, tile_count);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const auto counts = counts_.read_all<interop::PackedCount>(tile_count);
    record_count_ = 0;
    for (std::size_t i = 0; i < tile_count; ++i) {
        batch_tiles_[i].first_record = std::uint32_t(record_count_);
        record_count_ += counts[i].records;
    }
    tiles_.write(0, batch_tiles_.data(), batch_tiles_.size() * sizeof(interop::BrickTile));
}

/// Finds the slabs of the batch's voxels, and which of them need marks beside.
void SurfaceProducer::find_slabs(std::size_t tile_count) {
    const auto bind = [&] {
        tiles_.bind_storage(SSBO_BRICK_TILES);
        scratch_.bind_storage(SSBO_BRICK_SCRATCH);
        heads_.bind_storage(SSBO_BRICK_HEADS);
        counts_.bind_storage(SSBO_BRICK_COUNTS);
        marked_.bind_storage(SSBO_BRICK_MARKED);
        record_places_.bind_storage(SSBO_BRICK_RECORDS);
    };
    bind();
    marked_.fill(0);
    for (gl::Program* program : {&normals_, &flat_voxels_, &resolve_})
        program->set("record_count", unsigned(record_count_));
    dispatch(normals_, tile_count, record_count_);
    if (has_slabs()) {
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        for (std::size_t chunk = 0; chunk < pairs_.size(); ++chunk)
            run_pairs(slabs_, chunk);
        bind();
    }
    dispatch(flat_voxels_, tile_count, record_count_);
    dispatch(count_marks_, tile_count, tile_count);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

/// Gives the batch's bricks room in the pool. Empty ones need none: the oracle may let them through, with
/// N = 3, and with alpha masks, which the oracle decides exactly and bricks sample.
void SurfaceProducer::find_room(std::span<const BrickRequest> requests, BrickPool& pool,
                                std::span<ProducedTile> produced) {
    const auto counts = counts_.read_all<interop::PackedCount>(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (counts[i].words == 0) {
            produced[i].constant = true;
        } else if (pool.reserve(requests[i].slot, counts[i].words)) {
            batch_tiles_[i].first_word = pool.packed()->run(requests[i].slot).first;
        } else {
            produced[i].words_without_room = counts[i].words;
        }
    }
    tiles_.write(0, batch_tiles_.data(), batch_tiles_.size() * sizeof(interop::BrickTile));
}

/// Turns the gathered masks and sums of the batch into bricks.
void SurfaceProducer::pack(std::size_t tile_count, const BrickPool& pool) {
    pool.bind_for_writing();
    // Rays of an earlier pass may still read what was there.
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    dispatch(store_heads_, tile_count, tile_count * std::size_t(shape_.head_words()));
    dispatch(resolve_, tile_count, record_count_);
    // The next batch reuses the scratch; rays fetch the words.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace cairn::renderer
