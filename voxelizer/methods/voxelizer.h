#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gl/buffer.h"
#include "gl/shader_source.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

class PyramidBuilder;

/// Greatest number of voxels of a region along an axis (VOXEL_REGION_SIDE in the shaders).
constexpr int voxel_region_side = 16384;

/// How voxels are found. Only `conservative` is exact; the others are those of Forest et al. 2009, to compare
/// with.
enum class Method : std::uint8_t {
    /// Exactly the voxels whose closed box meets a triangle: conservative_voxelizer.h.
    conservative,
    slice_map,                ///< rasterized along z: raster_voxelizer.h
    three_axis,               ///< rasterized along x, y and z: raster_voxelizer.h
    three_axis_conservative,  ///< three_axis with enlarged triangles
};

/// The method of a name.
/// @throws Error  Fault::usage if there is no such method; the message lists the methods.
[[nodiscard]] Method method_named(std::string_view name);
[[nodiscard]] std::string_view name_of(Method method);
/// All methods, in the order of the enumeration.
[[nodiscard]] std::span<const Method> methods();

/// How much of a voxelization is done at a time. No voxel and no attribute depends on these numbers: they
/// bound the buffers and the time of a dispatch. A number under the least is taken for the least.
struct BatchLimits {
    std::uint32_t triangles = 1U << 18U;    ///< triangles that are marked in one pass; at least 1
    std::uint32_t candidates = 1U << 20U;   ///< voxels of masked triangles in one pass; at least a row's
    std::uint32_t pairs = 1U << 20U;        ///< pairs of triangle and voxel in one pass; at least a row's
    std::uint32_t part_voxels = 1U << 20U;  ///< voxels whose attributes are gathered at a time; at least 1
    std::uint32_t threads = 1U << 24U;      ///< threads that share queued triangles; at least one triangle's
    /// Render targets of a raster method; at least those of a tile of 32^3 voxels.
    std::size_t target_bytes = std::size_t(256) << 20U;

    /// These, with at least 1 of each.
    [[nodiscard]] BatchLimits usable() const;
};

/// Marks the voxels of a surface on the GPU, by one of the methods. Needs the current context of its
/// construction.
class Voxelizer {
public:
    virtual ~Voxelizer();
    Voxelizer(const Voxelizer&) = delete;
    Voxelizer(Voxelizer&&) = delete;
    Voxelizer& operator=(const Voxelizer&) = delete;
    Voxelizer& operator=(Voxelizer&&) = delete;

    /// The voxels of a region.
    /// @param subset  global numbers of the triangles to mark; none: all. It must hold every triangle that
    ///                meets the region; further ones only cost time. Far triangles are always marked.
    /// @throws Error  Fault::memory if the region's bits pass the driver's shader-storage limit: the message
    ///                says what would fit. Fault::usage if the region has more than voxel_region_side voxels
    ///                along an axis.
    [[nodiscard]] BitGrid voxelize(const GpuSurface& surface, const Region& region,
                                   std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

    /// Voxelizes into a grid of the caller's. If that held a region of this size before, nothing is allocated
    /// on the CPU or the GPU, except for voxels that alpha masks and far triangles leave to the CPU.
    void voxelize_into(const GpuSurface& surface, const Region& region, BitGrid& out,
                       std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

    /// Voxelizes and leaves the bits on the GPU. @return BitGrid::words of the region, valid until the next
    /// call.
    const gl::Buffer& voxelize_on_gpu(const GpuSurface& surface, const Region& region,
                                      std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

    /// Voxelizes the region and all coarser levels, both computed on the GPU.
    [[nodiscard]] BitmaskPyramid voxelize_pyramid(
        const GpuSurface& surface, const Region& region,
        std::optional<std::span<const std::uint32_t>> subset = std::nullopt,
        Reduction reduction = Reduction::xyz);

    /// Time of the last voxelization alone (no upload, no read-back, no pyramid), from an idle driver to an
    /// idle driver by the wall clock: the timer queries of llvmpipe do not see compute work.
    [[nodiscard]] double last_milliseconds() const { return last_milliseconds_; }
    /// Time of the coarser levels of the last pyramid, which comes on top of last_milliseconds().
    [[nodiscard]] double last_pyramid_milliseconds() const;

protected:
    explicit Voxelizer(const gl::ShaderSource& shaders);

    /// The triangles to mark of one chunk of the surface.
    struct ChunkPart {
        std::size_t count = 0;             ///< number of triangles
        std::optional<gl::Buffer> subset;  ///< numbers of the triangles in the chunk; none: all
    };
    /// @param parts  one per chunk of the surface
    /// @param bits   BitGrid::words of the region; undefined before the call, all written after it.
    virtual void mark(const GpuSurface& surface, const Region& region, std::span<const ChunkPart> parts,
                      gl::Buffer& bits) = 0;
    [[nodiscard]] const gl::ShaderSource& shaders() const { return shaders_; }

private:
    /// Marks the region in `bits_`, and measures the time.
    void mark_timed(const GpuSurface& surface, const Region& region,
                    std::optional<std::span<const std::uint32_t>> subset);

    gl::ShaderSource shaders_;
    std::unique_ptr<PyramidBuilder> pyramid_;
    gl::Buffer bits_;
    std::vector<ChunkPart> parts_;
    double last_milliseconds_ = 0.0;
};

[[nodiscard]] std::unique_ptr<Voxelizer> make_voxelizer(Method method, const gl::ShaderSource& shaders = {},
                                                        const BatchLimits& limits = {});

}  // namespace cairn::voxelizer
