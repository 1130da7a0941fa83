#include "voxelizer/methods/voxel_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/methods/masked_marker.h"
#include "voxelizer/methods/pyramid_builder.h"
#include "voxelizer/surface/far_clip.h"

namespace cairn::voxelizer {
namespace {

constexpr std::size_t header_bytes = 4 * sizeof(std::uint32_t);  // shaders/voxelize/attribute_pairs.glsl
constexpr std::size_t pair_bytes = 4 * sizeof(std::uint32_t);

void check(const GpuSurface& surface, const Region& region, const BitGrid& bits) {
    if (bits.size != region.size)
        throw Error(Fault::internal, "voxel attributes", "the bits are not of the region's size");
    for (const GpuSurfaceChunk& chunk : surface.chunks) {
        const std::size_t vertices = chunk.positions.size_bytes() / (3 * sizeof(std::int32_t));
        if (chunk.triangle_count > 0 &&
            chunk.attributes.size_bytes() < vertices * sizeof(interop::SurfaceAttributes)) {
            throw Error(Fault::internal, "voxel attributes",
                        "the surface was built without SurfaceOptions::attributes");
        }
    }
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    if (bit_bytes(bits.size) > limit) {
        throw Error(Fault::memory, "voxel attributes",
                    fmt::format("the voxels take {} MiB, more than a shader of this driver can see ({} MiB)",
                                bit_bytes(bits.size) >> 20, limit >> 20),
                    "gather them tile by tile");
    }
}

void set(const gl::Program& program, const char* name, unsigned x, unsigned y) {
    glProgramUniform2ui(program.id(), glGetUniformLocation(program.id(), name), x, y);
}

}  // namespace

AttributeVoxelizer::AttributeVoxelizer(const gl::ShaderSource& shaders, const BatchLimits& limits)
    : limits_(limits.usable()),
      list_small_(gl::build_compute(shaders, "voxelize/list_pairs.comp.glsl", {{"LARGE", "0"}})),
      list_large_(gl::build_compute(shaders, "voxelize/list_pairs.comp.glsl", {{"LARGE", "1"}})),
      gather_(gl::build_compute(shaders, "voxelize/gather_attributes.comp.glsl", {{"HAS_MASK", "0"}})),
      gather_masked_(gl::build_compute(shaders, "voxelize/gather_attributes.comp.glsl", {{"HAS_MASK", "1"}})),
      // Of the queues only the first: its place depends on no other's room.
      queue_((VOXEL_QUEUE_COUNT + std::size_t(limits_.triangles)) * sizeof(std::uint32_t),
             "attribute queue") {}

void AttributeVoxelizer::ChunkBinding::bind() const {
    chunk.positions.bind_storage(SSBO_SURFACE_POSITIONS);
    chunk.triangles.bind_storage(SSBO_SURFACE_TRIANGLES);
    chunk.attributes.bind_storage(SSBO_SURFACE_ATTRIBUTES);
    surface.materials.bind_storage(SSBO_SURFACE_MATERIALS);
    surface.bind_texels();
}

VoxelAttributes AttributeVoxelizer::gather(const GpuSurface& surface, const Region& region,
                                           const BitGrid& bits,
                                           std::optional<std::span<const std::uint32_t>> subset) {
    check(surface, region, bits);
    VoxelAttributes out;
    prepare(region, bits);
    const std::uint32_t total = slice_ranks_.back();
    if (total == 0) return out;
    out.colors.reserve(total);
    out.normals.reserve(total);
    const GpuSurfaceChunk far_chunk = upload_chunk(clip_far_triangles(surface.far_triangles, region));
    for (Part part{}; part.last < total;) {
        part = part_from(part.last, bits);
        sums_ = gl::Buffer(std::size_t(part.last - part.first) * ATTRIBUTE_SUM_WORDS * sizeof(std::uint32_t),
                           "attribute sums");
        sums_.fill(0);
        for (std::size_t i = 0; i < surface.chunks.size(); ++i) {
            const ChunkBinding chunk{surface, surface.chunks[i]};
            if (!subset) {
                gather_chunk(chunk, region, part, chunk.chunk.triangle_count, nullptr);
                continue;
            }
            const std::vector<std::uint32_t> local = surface.subset_in_chunk(*subset, i);
            const gl::Buffer buffer =
                gl::Buffer::of(std::span<const std::uint32_t>(local), "attribute subset");
            gather_chunk(chunk, region, part, local.size(), &buffer);
        }
        gather_chunk({surface, far_chunk}, region, part, far_chunk.triangle_count, nullptr);
        read_sums(part, out);
    }
    return out;
}

void AttributeVoxelizer::reserve_pairs(const Region& region) {
    const std::size_t room = std::max<std::size_t>(limits_.pairs, std::size_t(region.size.x));
    if (pair_room_ >= room) return;
    pair_room_ = room;
    pairs_ = gl::Buffer(header_bytes + pair_bytes * pair_room_, "attribute pairs");
}

void AttributeVoxelizer::prepare(const Region& region, const BitGrid& bits) {
    reserve_pairs(region);
    std::vector<std::uint32_t> ranks;
    ranks.reserve(bits.words.size() / VOXEL_RANK_WORDS + 1);
    const std::size_t slice_words = std::size_t(bits.words_per_row()) * std::size_t(bits.size.y);
    slice_ranks_.assign(1, 0);
    std::uint32_t rank = 0;
    for (std::size_t word = 0; word < bits.words.size(); ++word) {
        if (word % VOXEL_RANK_WORDS == 0) ranks.push_back(rank);
        rank += std::uint32_t(std::popcount(bits.words[word]));
        if ((word + 1) % slice_words == 0) slice_ranks_.push_back(rank);
    }
    ranks_ = gl::Buffer::of(std::span<const std::uint32_t>(ranks), "voxel ranks");
    bits_ = gl::Buffer::of(std::span<const std::uint32_t>(bits.words), "voxel bits");
    for (const gl::Program* program : {&list_small_, &list_large_, &gather_, &gather_masked_})
        set_region(*program, region);
}

AttributeVoxelizer::Part AttributeVoxelizer::part_from(std::uint32_t first, const BitGrid& bits) const {
    Part part{first, std::min<std::uint32_t>(slice_ranks_.back(), first + limits_.part_voxels), {}};
    const auto slice_of = [&](std::uint32_t rank) {
        return int(std::upper_bound(slice_ranks_.begin(), slice_ranks_.end(), rank) - slice_ranks_.begin()) -
               1;
    };
    part.slices = {slice_of(part.first), std::min(slice_of(part.last - 1), bits.size.z - 1)};
    return part;
}

void AttributeVoxelizer::gather_chunk(const ChunkBinding& chunk, const Region& region, const Part& part,
                                      std::size_t count, const gl::Buffer* subset) {
    for (const gl::Program* program : {&list_small_, &list_large_}) {
        program->set("part_slices", part.slices);
        set(*program, "part", part.first, part.last);
    }
    subset_ = subset;
    list_small_.set("has_subset", int(subset != nullptr));
    // If pairs find no room, half of the triangles are listed anew. One triangle that is not queued always
    // has room.
    std::vector<Work> waiting;
    for (std::size_t end = count; end > 0;) {
        const std::size_t batch = std::min<std::size_t>(end, limits_.triangles);
        end -= batch;
        waiting.push_back({unsigned(end), unsigned(batch), 0, 0});
    }
    while (!waiting.empty()) {
        const Work work = waiting.back();
        waiting.pop_back();
        queue_.fill(0, VOXEL_QUEUE_COUNT * sizeof(std::uint32_t), 0);
        const unsigned listed = list(list_small_, chunk, work, 1);
        if (listed > pair_room_) {
            const unsigned half = work.count / 2;
            waiting.push_back({work.first, half, 0, 0});
            waiting.push_back({work.first + half, work.count - half, 0, 0});
            continue;
        }
        gather_pairs(chunk, region, listed);
        const unsigned large = queue_.read_all<std::uint32_t>(1)[0];
        if (large > 0) gather_queued(chunk, region, large);
    }
}

void AttributeVoxelizer::gather_queued(const ChunkBinding& chunk, const Region& region, unsigned count) {
    // The loops of a thread over rows and voxels stay far from the limit that VOXEL_REGION_SIDE keeps.
    const unsigned rows_per_thread = std::max(1U, unsigned(VOXEL_REGION_SIDE / (16 * region.size.x)));
    std::vector<Work> waiting = {{0, count, 0, unsigned(region.size.y) * unsigned(region.size.z)}};
    while (!waiting.empty()) {
        const Work work = waiting.back();
        waiting.pop_back();
        const unsigned rows = work.last_row - work.first_row;
        const unsigned slices = (rows + rows_per_thread - 1) / rows_per_thread;
        const bool too_long = std::uint64_t(slices) * work.count > limits_.threads && work.count > 1;
        const unsigned listed = too_long ? 0 : list(list_large_, chunk, work, slices);
        if (!too_long && listed <= pair_room_) {
            gather_pairs(chunk, region, listed);
            continue;
        }
        // Half the triangles, then half the rows. One row always has room.
        const unsigned half = work.count / 2;
        const unsigned middle = work.first_row + rows / 2;
        if (half > 0) {
            waiting.push_back({work.first, half, work.first_row, work.last_row});
            waiting.push_back({work.first + half, work.count - half, work.first_row, work.last_row});
        } else {
            waiting.push_back({work.first, 1, work.first_row, middle});
            waiting.push_back({work.first, 1, middle, work.last_row});
        }
    }
}

unsigned AttributeVoxelizer::list(const gl::Program& program, const ChunkBinding& chunk, const Work& work,
                                  unsigned slices) {
    chunk.bind();
    ranks_.bind_storage(SSBO_ATTRIBUTE_RANKS);
    if (subset_ != nullptr) subset_->bind_storage(SSBO_ATTRIBUTE_SUBSET);
    bits_.bind_storage(SSBO_VOXEL_BITS);
    queue_.bind_storage(SSBO_VOXEL_QUEUE);
    pairs_.bind_storage(SSBO_ATTRIBUTE_PAIRS);
    pairs_.fill(0, header_bytes, 0);
    program.set("first", work.first);
    program.set("count", work.count);
    if (&program == &list_large_) {
        program.set("slice_count", slices);
        set(program, "row_range", work.first_row, work.last_row);
    }
    program.use();
    gl::dispatch_threads(std::size_t(work.count) * slices, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    return pairs_.read_all<std::uint32_t>(1)[0];
}

void AttributeVoxelizer::gather_pairs(const ChunkBinding& chunk, const Region& region, unsigned count) {
    if (count == 0) return;
    chunk.bind();
    sums_.bind_storage(SSBO_ATTRIBUTE_SUMS);
    const gl::Program& program = chunk.surface.has_mask ? gather_masked_ : gather_;
    set_region(program, region);
    program.set("count", count);
    program.use();
    gl::dispatch_threads(count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glFlush();
}

void AttributeVoxelizer::read_sums(const Part& part, VoxelAttributes& out) const {
    const std::size_t count = part.last - part.first;
    const auto sums = sums_.read_all<std::uint32_t>(count * ATTRIBUTE_SUM_WORDS);
    for (std::size_t voxel = 0; voxel < count; ++voxel) {
        std::array<double, ATTRIBUTE_SUM_WORDS / 2> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t place = voxel * ATTRIBUTE_SUM_WORDS + 2 * i;
            values[i] = double(std::int64_t(sums[place] | std::uint64_t(sums[place + 1]) << 32));
        }
        const glm::dvec3 color(values[1], values[2], values[3]);
        const glm::dvec3 normal(values[4], values[5], values[6]);
        // A sheet's two sides cancel but for the rounding of floats.
        constexpr double cancelled = 1.0 / 1024.0;
        const double length = glm::length(normal);
        const bool any = values[0] > 0.0;
        out.colors.emplace_back(any ? glm::clamp(color / values[0], 0.0, 1.0) : glm::dvec3(0.0));
        out.normals.emplace_back(length > cancelled * values[0] ? normal / length : glm::dvec3(0.0));
    }
}

}  // namespace cairn::voxelizer
