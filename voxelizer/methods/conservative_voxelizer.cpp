#include "voxelizer/methods/conservative_voxelizer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/surface/far_triangles.h"

namespace cairn::voxelizer {
namespace {

/// How many rows of a shared triangle a thread may have: its loops over rows and words stay far from the
/// limit that VOXEL_REGION_SIDE keeps.
unsigned thread_rows(const Region& region) {
    return unsigned(std::clamp(VOXEL_REGION_SIDE / (region.size.x / 32 + 4), 1, VOXEL_THREAD_ROWS));
}

}  // namespace

ConservativeVoxelizer::ConservativeVoxelizer(const gl::ShaderSource& shaders, const BatchLimits& limits)
    : Voxelizer(shaders),
      limits_(limits.usable()),
      mark_small_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "0"}})),
      mark_doubtful_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "1"}})),
      mark_large_(gl::build_compute(shaders, "voxelize/mark_large.comp.glsl")),
      queue_(VOXEL_QUEUE_COUNT * (1 + std::size_t(limits_.triangles)) * sizeof(std::uint32_t),
             "voxel queues") {}

void ConservativeVoxelizer::mark_doubtful(const Region& region, unsigned count) {
    set_region(mark_doubtful_, region);
    mark_doubtful_.set("count", count);
    mark_doubtful_.use();
    gl::dispatch_threads(count, THREADS_PER_GROUP);
}

/// Threads that share a triangle of a queue.
unsigned ConservativeVoxelizer::threads_per_triangle(const Region& region, unsigned queue) {
    unsigned of_class = VOXEL_SHARED_LEAST;
    for (unsigned smaller = VOXEL_QUEUE_SHARED; smaller < queue; ++smaller)
        of_class *= VOXEL_SHARED_FACTOR;
    // The region's largest triangle may need threads for twice its rows, because rows are shared unevenly.
    const glm::uvec3 size(region.size);
    const std::size_t rows = 2 * (std::size_t(size.y) * size.z + 8 * std::max(size.y, size.z));
    const std::size_t groups = rows / thread_rows(region) / THREADS_PER_GROUP + 1;
    const auto largest = unsigned(std::min<std::size_t>(groups, 65535) * THREADS_PER_GROUP);
    return queue + 1 == VOXEL_QUEUE_SHARED + VOXEL_SHARED_CLASSES ? largest : std::min(of_class, largest);
}

/// A dispatch is kept to a size that takes a fraction of a second, because some systems stop a driver that is
/// busy for longer.
void ConservativeVoxelizer::mark_queued(const Region& region, unsigned queue, unsigned count) {
    const unsigned threads = threads_per_triangle(region, queue);
    const unsigned triangles_at_once = std::max(limits_.threads / threads, 1U);
    set_region(mark_large_, region);
    mark_large_.set("queue", queue);
    mark_large_.set("threads_per_triangle", threads);
    mark_large_.use();
    for (unsigned first = 0; first < count; first += triangles_at_once) {
        const unsigned triangles = std::min(triangles_at_once, count - first);
        mark_large_.set("first", first);
        mark_large_.set("count", triangles);
        gl::dispatch_threads(std::size_t(triangles) * threads, THREADS_PER_GROUP);
        glFlush();
    }
}

ConservativeVoxelizer::QueueCounts ConservativeVoxelizer::mark_small(const Region& region,
                                                                     const ChunkPart& part, std::size_t first,
                                                                     std::size_t count) {
    queue_.fill(0, sizeof(QueueCounts), 0);
    // The batch before may have bound its candidates here.
    if (part.subset) part.subset->bind_storage(SSBO_VOXEL_SUBSET);
    set_region(mark_small_, region);
    mark_small_.set("first", unsigned(first));
    mark_small_.set("count", unsigned(count));
    mark_small_.set("has_subset", int(part.subset.has_value()));
    mark_small_.set("thread_rows", int(thread_rows(region)));
    mark_small_.use();
    gl::dispatch_threads(count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    QueueCounts counts{};
    queue_.read(0, counts.data(), sizeof(counts));
    return counts;
}

std::vector<MaskCandidate> ConservativeVoxelizer::mark_chunk(const Region& region, const ChunkPart& part) {
    std::vector<MaskCandidate> undecided;
    const std::size_t batch = limits_.triangles;
    for (std::size_t first = 0; first < part.count; first += batch) {
        const QueueCounts counts = mark_small(region, part, first, std::min(part.count - first, batch));
        if (counts[VOXEL_QUEUE_DOUBT] > 0) mark_doubtful(region, counts[VOXEL_QUEUE_DOUBT]);
        for (unsigned queue = VOXEL_QUEUE_SHARED; queue < VOXEL_QUEUE_SHARED + VOXEL_SHARED_CLASSES;
             ++queue) {
            if (counts[queue] > 0) mark_queued(region, queue, counts[queue]);
        }
        for (const unsigned queue : {VOXEL_QUEUE_MASKED_SMALL, VOXEL_QUEUE_MASKED_LARGE}) {
            if (counts[queue] == 0) continue;
            if (!masked_) masked_.emplace(shaders(), limits_);
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
        const std::vector<MaskCandidate> undecided = mark_chunk(region, parts[chunk]);
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
