#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "gl/buffer.h"
#include "gl/program.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/masked_marker.h"
#include "voxelizer/surface.h"

namespace cairn::voxelizer {

/// Marks every voxel whose closed box meets a triangle of the surface: never one fewer, never one more, the
/// same bits on every driver. Runs on the GPU; needs the current context of its construction.
///
/// Separating axes: Akenine-Möller 2001; row spans: Schwarz and Seidel 2010, section 3.
class Voxelizer {
public:
    explicit Voxelizer(const gl::ShaderSource& shaders = {});

    /// @param subset  global triangle numbers, or none for all. Must hold every triangle that meets the
    ///                region for the bits to be right; others cost time only. Far triangles are always
    ///                marked.
    /// @throws Error  Fault::memory when the region's bits pass the driver's shader-storage limit: the
    ///                message says what would fit. Fault::usage when the region has more than
    ///                VOXEL_REGION_SIDE voxels along an axis.
    [[nodiscard]] BitGrid voxelize(const GpuSurface& surface, const Region& region,
                                   std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

    /// The same with all coarser levels, both computed on the GPU.
    [[nodiscard]] BitmaskPyramid voxelize_pyramid(
        const GpuSurface& surface, const Region& region,
        std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

    /// The voxelization alone of the last call (no upload, no read-back, no pyramid), from an idle driver to
    /// an idle driver by the wall clock: the timer queries of llvmpipe do not see compute work.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }

private:
    /// Marks the region in `bits_`.
    void mark(const GpuSurface& surface, const Region& region,
              std::optional<std::span<const std::uint32_t>> subset);
    /// Marks the bound chunk, or the bound subset of it; returns what the shaders left to the CPU.
    std::vector<MaskCandidate> mark_chunk(const Region& region, std::size_t count, bool has_subset);
    void mark_doubtful(const Region& region, unsigned count);
    void mark_queued(const Region& region, unsigned queue, unsigned count);
    /// Adds far triangles, and voxels that the CPU found.
    void mark_on_cpu(const GpuSurface& surface, const Region& region, const std::vector<glm::ivec3>& voxels);
    [[nodiscard]] static BitGrid read_bits(const gl::Buffer& bits, const glm::ivec3& size);

    gl::ShaderSource shaders_;
    gl::Program mark_small_;
    gl::Program mark_doubtful_;
    gl::Program mark_large_;
    gl::Program halve_;
    std::optional<MaskedMarker> masked_;  ///< built when a surface first needs it
    gl::Buffer queue_;
    gl::Buffer bits_;
    double last_milliseconds_ = 0.0;
};

}  // namespace cairn::voxelizer
