#include "voxelizer/voxelizer.h"

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

using Subset = std::optional<std::span<const std::uint32_t>>;

std::size_t bit_bytes(const glm::ivec3& size) {
    return std::size_t((size.x + 31) / 32) * std::size_t(size.y) * std::size_t(size.z) *
           sizeof(std::uint32_t);
}

void check_region(const Region& region) {
    if (region.level < 0 || region.level > LATTICE_BITS ||
        glm::any(glm::lessThan(region.size, glm::ivec3(1)))) {
        throw Error(Fault::usage, "region",
                    fmt::format("level {} and size {} x {} x {} are out of range", region.level,
                                region.size.x, region.size.y, region.size.z));
    }
    if (glm::any(glm::greaterThan(region.size, glm::ivec3(VOXEL_REGION_SIDE)))) {
        throw Error(Fault::usage, "region",
                    fmt::format("{} x {} x {} voxels are too many along one axis", region.size.x,
                                region.size.y, region.size.z),
                    fmt::format("cut it in parts of at most {}", VOXEL_REGION_SIDE));
    }
    const std::size_t limit = gl::query_limits().shader_storage_bytes;
    const double bytes = std::ceil(region.size.x / 32.0) * 4.0 * region.size.y * region.size.z;
    if (bytes <= double(limit)) return;
    const int side = int(std::cbrt(double(limit) * 8.0)) / 32 * 32;
    throw Error(
        Fault::memory, "voxels",
        fmt::format("{} x {} x {} take {:.0f} MiB, more than a shader of this driver can see ({} MiB)",
                    region.size.x, region.size.y, region.size.z, bytes / 0x1p20, limit >> 20),
        fmt::format("{0} x {0} x {0} would fit", side));
}

/// How many rows of a large triangle a thread may have: its loops over rows and words stay far from the limit
/// that VOXEL_REGION_SIDE tells of.
unsigned thread_rows(const Region& region) {
    return unsigned(std::clamp(VOXEL_REGION_SIDE / (region.size.x / 32 + 4), 1, VOXEL_THREAD_ROWS));
}

/// The part of a subset that lies in one chunk, by the chunk's own numbers.
std::vector<std::uint32_t> subset_in_chunk(std::span<const std::uint32_t> subset, std::size_t chunk) {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t triangle : subset) {
        if (triangle / SURFACE_CHUNK_TRIANGLES == chunk) out.push_back(triangle % SURFACE_CHUNK_TRIANGLES);
    }
    return out;
}

}  // namespace

Voxelizer::Voxelizer(const gl::ShaderSource& shaders)
    : shaders_(shaders),
      mark_small_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "0"}})),
      mark_doubtful_(gl::build_compute(shaders, "voxelize/mark_small.comp.glsl", {{"EXACT", "1"}})),
      mark_large_(gl::build_compute(shaders, "voxelize/mark_large.comp.glsl")),
      halve_(gl::build_compute(shaders, "voxelize/halve.comp.glsl")),
      queue_(VOXEL_QUEUE_COUNT * (1 + std::size_t(VOXEL_BATCH_TRIANGLES)) * sizeof(std::uint32_t),
             "voxel queues") {}

void Voxelizer::mark_doubtful(const Region& region, unsigned count) {
    set_region(mark_doubtful_, region);
    mark_doubtful_.set("count", count);
    mark_doubtful_.use();
    gl::dispatch_threads(count, VOXEL_GROUP);
}

/// A huge triangle gets as many workgroups as the region's largest may need; a dispatch is kept to a size
/// that takes a fraction of a second, because some systems stop a driver that is busy for longer.
void Voxelizer::mark_queued(const Region& region, unsigned queue, unsigned count) {
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

std::vector<MaskCandidate> Voxelizer::mark_chunk(const Region& region, std::size_t count, bool has_subset) {
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
        const auto counts = queue_.read_all<std::uint32_t>(VOXEL_QUEUE_COUNT);
        if (counts[VOXEL_QUEUE_DOUBT] > 0) mark_doubtful(region, counts[VOXEL_QUEUE_DOUBT]);
        for (const unsigned queue : {VOXEL_QUEUE_LARGE, VOXEL_QUEUE_HUGE}) {
            if (counts[queue] > 0) mark_queued(region, queue, counts[queue]);
        }
        for (const unsigned queue : {VOXEL_QUEUE_MASKED_SMALL, VOXEL_QUEUE_MASKED_LARGE}) {
            if (counts[queue] == 0) continue;
            if (!masked_) masked_.emplace(shaders_);
            glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
            const std::vector<MaskCandidate> more = masked_->mark(region, queue, counts[queue]);
            undecided.insert(undecided.end(), more.begin(), more.end());
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }
    return undecided;
}

void Voxelizer::mark(const GpuSurface& surface, const Region& region, Subset subset) {
    check_region(region);
    const std::size_t bytes = bit_bytes(region.size);
    if (bits_.size_bytes() != bytes) bits_ = gl::Buffer(bytes, "voxel bits");
    std::vector<gl::Buffer> subsets;
    std::vector<std::size_t> counts;
    for (std::size_t chunk = 0; chunk < surface.chunks.size(); ++chunk) {
        counts.push_back(surface.chunks[chunk].triangle_count);
        if (!subset) continue;
        const std::vector<std::uint32_t> local = subset_in_chunk(*subset, chunk);
        counts.back() = local.size();
        subsets.push_back(gl::Buffer::of(std::span<const std::uint32_t>(local), "voxel subset"));
    }
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    bits_.fill(0);
    bits_.bind_storage(SSBO_VOXEL_BITS);
    queue_.bind_storage(SSBO_VOXEL_QUEUE);
    std::vector<glm::ivec3> voxels;
    for (std::size_t chunk = 0; chunk < surface.chunks.size(); ++chunk) {
        surface.bind(chunk);
        if (subset) subsets[chunk].bind_storage(SSBO_VOXEL_SUBSET);
        const std::vector<MaskCandidate> undecided = mark_chunk(region, counts[chunk], subset.has_value());
        if (undecided.empty()) continue;
        const std::vector<glm::ivec3> found = decide_on_cpu(undecided, surface, chunk, region);
        voxels.insert(voxels.end(), found.begin(), found.end());
    }
    if (!voxels.empty() || !surface.far_triangles.empty()) mark_on_cpu(surface, region, voxels);
    glFinish();
    last_milliseconds_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void Voxelizer::mark_on_cpu(const GpuSurface& surface, const Region& region,
                            const std::vector<glm::ivec3>& voxels) {
    BitGrid bits = read_bits(bits_, region.size);
    for (const glm::ivec3& voxel : voxels)
        bits.set(voxel - region.origin);
    const auto materials = surface.materials.read_all<interop::SurfaceMaterial>(
        surface.materials.size_bytes() / sizeof(interop::SurfaceMaterial));
    const auto texels =
        surface.texels.read_all<std::uint32_t>(surface.texels.size_bytes() / sizeof(std::uint32_t));
    mark_far_triangles(surface.far_triangles, materials, texels, region, bits);
    bits_.write(0, bits.words.data(), bits.words.size() * sizeof(std::uint32_t));
}

BitGrid Voxelizer::read_bits(const gl::Buffer& bits, const glm::ivec3& size) {
    BitGrid out(size);
    bits.read(0, out.words.data(), out.words.size() * sizeof(std::uint32_t));
    return out;
}

BitGrid Voxelizer::voxelize(const GpuSurface& surface, const Region& region, Subset subset) {
    mark(surface, region, subset);
    return read_bits(bits_, region.size);
}

BitmaskPyramid Voxelizer::voxelize_pyramid(const GpuSurface& surface, const Region& region, Subset subset) {
    mark(surface, region, subset);
    std::vector<BitGrid> levels;
    levels.push_back(read_bits(bits_, region.size));
    const gl::Buffer* fine = &bits_;
    std::array<gl::Buffer, 2> coarse;
    for (glm::ivec3 size = region.size; size != glm::ivec3(1);) {
        const glm::ivec3 half = (size + 1) / 2;
        gl::Buffer& out = coarse[levels.size() % 2];
        out = gl::Buffer(std::max<std::size_t>(bit_bytes(half), 16), "voxel pyramid");
        fine->bind_storage(SSBO_HALVE_FINE);
        out.bind_storage(SSBO_HALVE_COARSE);
        halve_.set("fine_size", size);
        halve_.use();
        gl::dispatch_threads(bit_bytes(half) / sizeof(std::uint32_t), VOXEL_GROUP);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        levels.push_back(read_bits(out, half));
        fine = &out;
        size = half;
    }
    return BitmaskPyramid(std::move(levels));
}

}  // namespace cairn::voxelizer
