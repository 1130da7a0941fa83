#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gl/program.h"
#include "voxelizer/methods/masked_marker.h"
#include "voxelizer/methods/voxelizer.h"

namespace cairn::voxelizer {

/// Marks exactly the voxels whose closed box meets a triangle of the surface: no voxel less, none more, and
/// the same bits on every driver.
///
/// Separating axes: Akenine-Möller 2001; row spans: Schwarz and Seidel 2010, section 3.
class ConservativeVoxelizer final : public Voxelizer {
public:
    explicit ConservativeVoxelizer(const gl::ShaderSource& shaders = {});

private:
    void mark(const GpuSurface& surface, const Region& region, std::span<const ChunkPart> parts,
              gl::Buffer& bits) override;
    /// Marks the bound chunk, or its bound subset; returns the candidates that the shaders left to the CPU.
    std::vector<MaskCandidate> mark_chunk(const Region& region, std::size_t count, bool has_subset);
    void mark_doubtful(const Region& region, unsigned count);
    [[nodiscard]] static unsigned threads_per_triangle(const Region& region, unsigned queue);
    void mark_queued(const Region& region, unsigned queue, unsigned count);
    /// Marks far triangles, and the voxels that the CPU found.
    static void mark_on_cpu(const GpuSurface& surface, const Region& region,
                            const std::vector<glm::ivec3>& voxels, gl::Buffer& bits);

    gl::Program mark_small_;
    gl::Program mark_doubtful_;
    gl::Program mark_large_;
    std::optional<MaskedMarker> masked_;  ///< built when a surface first needs it
    gl::Buffer queue_;
};

}  // namespace cairn::voxelizer
