#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gl/program.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/methods/masked_marker.h"
#include "voxelizer/methods/voxelizer.h"

namespace cairn::voxelizer {

/// Marks exactly the voxels whose closed box meets a triangle of the surface: no voxel less, none more, and
/// the same bits on every driver.
///
/// Separating axes: Akenine-Möller 2001; row spans: Schwarz and Seidel 2010, section 3.
class ConservativeVoxelizer final : public Voxelizer {
public:
    explicit ConservativeVoxelizer(const gl::ShaderSource& shaders = {}, const BatchLimits& limits = {});

private:
    using QueueCounts = std::array<std::uint32_t, VOXEL_QUEUE_COUNT>;

    void mark(const GpuSurface& surface, const Region& region, std::span<const ChunkPart> parts,
              gl::Buffer& bits) override;
    /// Marks a part of the bound chunk; returns the candidates that the shaders left to the CPU.
    std::vector<MaskCandidate> mark_chunk(const Region& region, const ChunkPart& part);
    /// Marks the small triangles of a part from number `first` on, and puts the others into queues.
    /// @return number of triangles in each queue
    [[nodiscard]] QueueCounts mark_small(const Region& region, const ChunkPart& part, std::size_t first,
                                         std::size_t count);
    void mark_doubtful(const Region& region, unsigned count);
    [[nodiscard]] static unsigned threads_per_triangle(const Region& region, unsigned queue);
    void mark_queued(const Region& region, unsigned queue, unsigned count);
    /// Marks far triangles, and the voxels that the CPU found.
    static void mark_on_cpu(const GpuSurface& surface, const Region& region,
                            const std::vector<glm::ivec3>& voxels, gl::Buffer& bits);

    BatchLimits limits_;
    gl::Program mark_small_;
    gl::Program mark_doubtful_;
    gl::Program mark_large_;
    std::optional<MaskedMarker> masked_;  ///< built when a surface first needs it
    gl::Buffer queue_;
};

}  // namespace cairn::voxelizer
