#include "voxelizer/conservative_voxelizer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/bindings.h"
#include "voxelizer/far_triangles.h"

namespace cairn::voxelizer {
namespace {

/// How many rows of a large triangle a thread may have: its loops over rows and words stay far from the limit
/// that VOXEL_REGION_SIDE tells of.
unsigned thread_rows(const Region& region) {
    return unsigned(std::clamp(VOXEL_REGION_SIDE / (region.size.x / 32 + 4), 1, VOXEL_THREAD_ROWS));
}

}  // namespace

ConservativeVoxelizer::ConservativeVoxelizer(const gl::ShaderSource& shaders)
    : Voxelizer(shaders),
      mark_small_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "0"}})),
      mark_doubtful_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "1"}})),
      mark_large_(gl::build_compute(shaders, "voxelize/mark_large.comp.glsl")),
      queue_(VOXEL_QUEUE_COUNT * (1 + std::size_t(VOXEL_BATCH_TRIANGLES)) * sizeof(std::uint32_t),
             "voxel queues") {}

void ConservativeVoxelizer::mark_doubtful(const Region& region, unsigned count) {
    set_region(mark_doubtful_, region);
    mark_doubtful_.set("count", count);
    mark_doubtful_.use();
    gl::dispatch_threads(count, VOXEL_GROUP);
}

/// A huge triangle gets as many workgroups as the region's largest may need; a dispatch is kept to a size
/// that takes a fraction of a second, because some systems stop a driver that is busy for longer.
void ConservativeVoxelizer::mark_queued(const Region& region, unsigned queue, unsigned count) {
    constexpr unsigned groups_at_once = 1U << 20;
    const glm::uvec3 size(region.size);
    // Twice the rows, because steps are shared unevenly.
    const unsigned rows = 2 * (size.y * size.z + 8 * std::max(size.y, size.z));
    const unsigned rows_a_group = thread_rows(region) * VOXEL_GROUP;
    const unsigned slices =
        queue == VOXEL_QUEUE_LARGE ? 1 : std::min((rows + rows_a_group - 1) / rows_a_group, 65535U);
    const unsigned triangles_at_once = std::clamp(groups_at_once / slices, 1U, 65535U);
    set_region(mark_large_, region);
    mark_large_.set("queue", queue);
    mark_large_.set("slice_count", slices);
    mark_large_.use();
    for (unsigned first = 0; first < count; first += triangles_at_once) {
        mark_large_.set("first", first);
        glDispatchCompute(slices, std::min(triangles_at_once, count - first), 1);
        glFlush();
    }
}

std::vector<MaskCandidate> ConservativeVoxelizer::mark_chunk(const Region& region, std::size_t count,
                                                             bool has_subset) {
    std::vector<MaskCandidate> undecided;
    for (std::size_t first = 0; first < count; first += VOXEL_BATCH_TRIANGLES) {
        const std::size_t batch = std::min<std::size_t>(count - first, VOXEL_BATCH_TRIANGLES);
        queue_.fill(0, VOXEL_QUEUE_COUNT * sizeof(std::uint32_t), 0);
        set_region(mark_small_, region);
        mark_small_.set("first", unsigned(first));
        mark_small_.set("count", unsigned(batch));
        mark_small_.set("has_subset", int(has_subset));
        mark_small_.set("thread_rows", int(thread_rows(region)));
        mark_small_.use();
        gl::dispatch_threads(batch, VOXEL_GROUP);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        std::array<std::uint32_t, VOXEL_QUEUE_COUNT> counts{};
        queue_.read(0, counts.data(), sizeof(counts));
        if (counts[VOXEL_QUEUE_DOUBT] > 0) mark_doubtful(region, counts[VOXEL_QUEUE_DOUBT]);
        for (const unsigned queue : {VOXEL_QUEUE_LARGE, VOXEL_QUEUE_HUGE}) {
            if (counts[queue] > 0) mark_queued(region, queue, counts[queue]);
        }
        for (const unsigned queue : {VOXEL_QUEUE_MASKED_SMALL, VOXEL_QUEUE_MASKED_LARGE}) {
            if (counts[queue] == 0) continue;
            if (!masked_) masked_.emplace(shaders());
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
            const std::vector<MaskCandidate> more = masked_->mark(region, queue, counts[queue]);
            undecided.insert(undecided.end(), more.begin(), more.end());
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    return undecided;
}

void ConservativeVoxelizer::mark(const GpuSurface& surface, const Region& region,
                                 std::span<const ChunkPart> parts, gl::Buffer& bits) {
    bits.fill(0);
    bits.bind_storage(SSBO_VOXEL_BITS);
    queue_.bind_storage(SSBO_VOXEL_QUEUE);
    std::vector<glm::ivec3> voxels;
    for (std::size_t chunk = 0; chunk < surface.chunks.size(); ++chunk) {
        surface.bind(chunk);
        if (parts[chunk].subset) parts[chunk].subset->bind_storage(SSBO_VOXEL_SUBSET);
        const std::vector<MaskCandidate> undecided =
            mark_chunk(region, parts[chunk].count, parts[chunk].subset.has_value());
        if (undecided.empty()) continue;
        const std::vector<glm::ivec3> found = decide_on_cpu(undecided, surface, chunk, region);
        voxels.insert(voxels.end(), found.begin(), found.end());
    }
    if (!voxels.empty() || !surface.far_triangles.empty()) mark_on_cpu(surface, region, voxels, bits);
}

void ConservativeVoxelizer::mark_on_cpu(const GpuSurface& surface, const Region& region,
                                        const std::vector<glm::ivec3>& voxels, gl::Buffer& bits_buffer) {
    BitGrid bits(region.size);
    bits_buffer.read(0, bits.words.data(), bits.words.size() * sizeof(std::uint32_t));
    for (const glm::ivec3& voxel : voxels)
        bits.set(voxel - region.origin);
    const auto materials = surface.materials.read_all<interop::SurfaceMaterial>(
        surface.materials.size_bytes() / sizeof(interop::SurfaceMaterial));
    const auto texels =
        surface.texels.read_all<std::uint32_t>(surface.texels.size_bytes() / sizeof(std::uint32_t));
    mark_far_triangles(surface.far_triangles, materials, texels, region, bits);
    bits_buffer.write(0, bits.words.data(), bits.words.size() * sizeof(std::uint32_t));
}

}  // namespace cairn::voxelizer
