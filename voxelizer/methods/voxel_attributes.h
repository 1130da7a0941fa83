#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "voxelizer/bit_grid.h"
#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Gathers the mean base colour and normal of the surface inside each occupied voxel, on the GPU. Needs the
/// current context of its construction.
///
/// The weight of a triangle is the area of its part inside the closed voxel. Base colour is factor times
/// vertex colour times texture (level 0, the nearest texel), in linear space; parts that an alpha mask cuts
/// away do not count. If a texture varies on a part, the mean is estimated from up to 64 samples for each of
/// the part's corners past the second. A part without area (of a line, a point, or a triangle that only
/// touches) weighs 2^-22 of a voxel's face, so that it counts only if no other part is there. A triangle that
/// reaches further than one root cube past the grid (FarTriangle) has the normal of its plane.
///
/// The bits do not depend on the order of the triangles, and are the same for a tile alone and in a larger
/// region.
class AttributeVoxelizer {
public:
    explicit AttributeVoxelizer(const gl::ShaderSource& shaders = {}, const BatchLimits& limits = {});

    /// @param surface  built with SurfaceOptions::attributes
    /// @param bits     bits of the region. An occupied voxel that no triangle of the surface touches (inside
    ///                 a solid) gets colour and normal 0.
    /// @param subset   as in Voxelizer::voxelize
    /// @throws Error   Fault::memory if the bits pass the driver's shader-storage limit: then gather tile by
    /// tile.
    ///
    /// Memory: 56 bytes per occupied voxel, at most 56 MiB, 16 MiB of pairs, and the bits.
    [[nodiscard]] VoxelAttributes gather(const GpuSurface& surface, const Region& region, const BitGrid& bits,
                                         std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

private:
    /// A range of occupied voxels, by rank, that are gathered at a time.
    struct Part {
        std::uint32_t first, last;  ///< first rank, and one past the last
        glm::ivec2 slices;          ///< first and last z of the voxels
    };
    /// Some triangles, and a range of rows of the bounding box of each.
    struct Work {
        unsigned first, count;
        unsigned first_row, last_row;
    };
    struct ChunkBinding {
        const GpuSurface& surface;
        const GpuSurfaceChunk& chunk;
        void bind() const;
    };

    /// Makes room for the pairs of a row of the region at least.
    void reserve_pairs(const Region& region);
    void prepare(const Region& region, const BitGrid& bits);
    [[nodiscard]] Part part_from(std::uint32_t first, const BitGrid& bits) const;
    void gather_chunk(const ChunkBinding& chunk, const Region& region, const Part& part, std::size_t count,
                      const gl::Buffer* subset);
    void gather_queued(const ChunkBinding& chunk, const Region& region, unsigned count);
    /// Runs a list program over some triangles. @return number of pairs.
    [[nodiscard]] unsigned list(const gl::Program& program, const ChunkBinding& chunk, const Work& work,
                                unsigned slices);
    void gather_pairs(const ChunkBinding& chunk, const Region& region, unsigned count);
    void read_sums(const Part& part, VoxelAttributes& out) const;

    BatchLimits limits_;
    gl::Program list_small_;
    gl::Program list_large_;
    gl::Program gather_;
    gl::Program gather_masked_;
    gl::Buffer queue_;
    std::size_t pair_room_ = 0;  ///< pairs that have room
    gl::Buffer pairs_;
    gl::Buffer bits_;
    gl::Buffer ranks_;
    gl::Buffer sums_;
    const gl::Buffer* subset_ = nullptr;
    std::vector<std::uint32_t> slice_ranks_;  ///< occupied voxels before each z, and in all
};

}  // namespace cairn::voxelizer
