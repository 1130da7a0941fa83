#include "voxelizer/methods/masked_marker.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "shaders/interop/threads.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/surface/exact_mask.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::voxelizer {
namespace {

constexpr std::size_t header_words = 4;  // shaders/voxelize/candidates.glsl
constexpr std::size_t header_bytes = header_words * sizeof(std::uint32_t);

}  // namespace

void set_region(const gl::Program& program, const Region& region) {
    program.set("region_origin", region.origin);
    program.set("region_size", region.size);
    program.set("voxel_shift", LATTICE_BITS - region.level);
}

MaskedMarker::MaskedMarker(const gl::ShaderSource& shaders, const BatchLimits& limits)
    : list_(gl::build_compute(shaders, "voxelize/list_masked.comp.glsl")),
      decide_(gl::build_compute(shaders, "voxelize/decide_masked.comp.glsl")),
      limits_(limits) {}

void MaskedMarker::reserve(const Region& region) {
    const std::size_t room = std::max<std::size_t>(limits_.candidates, std::size_t(region.size.x));
    if (room_ >= room) return;
    room_ = room;
    candidates_ = gl::Buffer(header_bytes + sizeof(MaskCandidate) * room_, "mask candidates");
}

std::vector<MaskCandidate> MaskedMarker::mark(const Region& region, unsigned queue, unsigned count) {
    set_region(decide_, region);
    reserve(region);
    candidates_.bind_storage(SSBO_VOXEL_CANDIDATES);
    std::vector<MaskCandidate> undecided;
    waiting_.assign(1, {0, count, 0, unsigned(region.size.y) * unsigned(region.size.z)});
    while (!waiting_.empty()) {
        const Work work = waiting_.back();
        waiting_.pop_back();
        const unsigned listed = list(region, queue, work);
        if (listed <= room_) {
            decide(listed, undecided);
            continue;
        }
        // Too many at once: half the triangles, then half the rows. One row always has room.
        const unsigned half = work.count / 2;
        const unsigned middle = (work.first_row + work.last_row) / 2;
        if (half > 0) {
            waiting_.push_back({work.first, half, work.first_row, work.last_row});
            waiting_.push_back({work.first + half, work.count - half, work.first_row, work.last_row});
        } else {
            waiting_.push_back({work.first, 1, work.first_row, middle});
            waiting_.push_back({work.first, 1, middle, work.last_row});
        }
    }
    return undecided;
}

unsigned MaskedMarker::list(const Region& region, unsigned queue, const Work& work) {
    // The loops of a thread over rows and voxels stay far from the limit that VOXEL_REGION_SIDE keeps.
    const unsigned rows = work.last_row - work.first_row;
    const unsigned rows_per_thread = std::max(1U, unsigned(VOXEL_REGION_SIDE / region.size.x));
    const unsigned slices =
        queue == VOXEL_QUEUE_MASKED_SMALL ? 1 : (rows + rows_per_thread - 1) / rows_per_thread;
    candidates_.fill(0, header_bytes, 0);
    set_region(list_, region);
    list_.set("queue", queue);
    list_.set("slice_count", slices);
    glProgramUniform2ui(list_.id(), glGetUniformLocation(list_.id(), "row_range"), work.first_row,
                        work.last_row);
    list_.use();
    const unsigned at_once = std::max(1U, limits_.threads / slices);
    for (unsigned done = 0; done < work.count; done += at_once) {
        const unsigned count = std::min(at_once, work.count - done);
        list_.set("first", work.first + done);
        list_.set("count", count);
        gl::dispatch_threads(std::size_t(count) * slices, THREADS_PER_GROUP);
    }
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    return header().listed;
}

MaskedMarker::Header MaskedMarker::header() const {
    Header header{};
    candidates_.read(0, &header, sizeof(header));
    return header;
}

void MaskedMarker::decide(unsigned count, std::vector<MaskCandidate>& undecided) {
    decide_.use();
    gl::dispatch_threads(count, THREADS_PER_GROUP);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    if (header().undecided == 0) return;
    for (const MaskCandidate& candidate : candidates_.read_all<MaskCandidate>(count, header_bytes)) {
        if (candidate.triangle < 0) undecided.push_back({candidate.voxel, -1 - candidate.triangle});
    }
}

std::vector<glm::ivec3> decide_on_cpu(const std::vector<MaskCandidate>& candidates, const GpuSurface& surface,
                                      std::size_t chunk, const Region& region) {
    const GpuSurfaceChunk& on_gpu = surface.chunks[chunk];
    const auto read = [](const gl::Buffer& buffer, auto example) {
        return buffer.read_all<decltype(example)>(buffer.size_bytes() / sizeof(example));
    };
    const auto positions = read(on_gpu.positions, std::array<std::int32_t, 3>());
    const auto triangles = read(on_gpu.triangles, interop::SurfaceTriangle());
    const auto attributes = read(on_gpu.attributes, interop::SurfaceAttributes());
    const auto materials = read(surface.materials, interop::SurfaceMaterial());
    const auto texels = read(surface.texels, std::uint32_t());
    const std::int64_t side = region.voxel_side();
    std::vector<char> is_surface(candidates.size());
    tbb::parallel_for(std::size_t(0), candidates.size(), [&](std::size_t i) {
        const interop::SurfaceTriangle& triangle = triangles[std::size_t(candidates[i].triangle)];
        const glm::uvec3& vertices = triangle.vertices;
        std::array<glm::i64vec3, 3> corners;
        std::array<glm::vec2, 3> texcoords;
        std::array<std::uint16_t, 3> alphas{};
        for (int corner = 0; corner < 3; ++corner) {
            const auto& p = positions[vertices[corner]];
            corners[std::size_t(corner)] = {p[0], p[1], p[2]};
            texcoords[std::size_t(corner)] = texcoord_of(attributes[vertices[corner]]);
            alphas[std::size_t(corner)] = alpha_of(attributes[vertices[corner]]);
        }
        const ExactMask mask(corners, texcoords, alphas, materials[triangle.material], texels);
        is_surface[i] = mask.touches(glm::i64vec3(candidates[i].voxel) * side, side) ? 1 : 0;
    });
    std::vector<glm::ivec3> voxels;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (is_surface[i] != 0) voxels.push_back(candidates[i].voxel);
    }
    return voxels;
}

}  // namespace cairn::voxelizer
