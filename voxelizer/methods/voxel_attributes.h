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
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Gathers the mean base colour and normal of the surface inside each occupied voxel, on the GPU. Needs the
/// current context of its construction.
///
/// Each triangle counts with the area of its part inside the closed voxel. Base colour is factor times vertex
/// colour times texture (level 0, the nearest texel), in linear space; what an alpha mask cuts away does not
/// count. Where a texture varies on a part, up to 64 samples for each of its corners past the second estimate
/// the mean. What has no area (lines, points, contact) counts as 2^-22 of a voxel's face: only where nothing
/// else is. A triangle that reaches further than one root cube past the grid (FarTriangle) has its own
/// plane's normal.
///
/// The same bits whatever the order of the triangles, and for a tile alone as for the same place in a whole.
class AttributeVoxelizer {
public:
    explicit AttributeVoxelizer(const gl::ShaderSource& shaders = {});

    /// @param surface  built with SurfaceOptions::attributes
    /// @param bits     of the region. An occupied voxel that no triangle of the surface touches (the inside
    /// of
    ///                 a solid) gets colour and normal 0.
    /// @param subset   as in Voxelizer::voxelize
    /// @throws Error   Fault::memory when the bits pass the driver's shader-storage limit: gather tile by
    /// tile.
    ///
    /// Memory: 56 bytes per occupied voxel, at most 56 MiB, 16 MiB of pairs, and the bits.
    [[nodiscard]] VoxelAttributes gather(const GpuSurface& surface, const Region& region, const BitGrid& bits,
                                         std::optional<std::span<const std::uint32_t>> subset = std::nullopt);

private:
    /// Occupied voxels that are gathered at a time, by their rank.
    struct Part {
        std::uint32_t first, last;  ///< ranks; last is one past
        glm::ivec2 slices;          ///< z that they lie in, inclusive
    };
    /// Some triangles, and of each so many rows of its bounding box.
    struct Work {
        unsigned first, count;
        unsigned first_row, last_row;
    };
    struct ChunkBinding {
        const GpuSurface& surface;
        const GpuSurfaceChunk& chunk;
        void bind() const;
    };

    void prepare(const Region& region, const BitGrid& bits);
    [[nodiscard]] Part part_from(std::uint32_t first, const BitGrid& bits) const;
    void gather_chunk(const ChunkBinding& chunk, const Region& region, const Part& part, std::size_t count,
                      const gl::Buffer* subset);
    void gather_queued(const ChunkBinding& chunk, const Region& region, unsigned count);
    /// Runs a list program over some triangles; @return how many pairs there are.
    [[nodiscard]] unsigned list(const gl::Program& program, const ChunkBinding& chunk, const Work& work,
                                unsigned slices);
    void gather_pairs(const ChunkBinding& chunk, const Region& region, unsigned count);
    void read_sums(const Part& part, VoxelAttributes& out) const;

    gl::Program list_small_;
    gl::Program list_large_;
    gl::Program gather_;
    gl::Program gather_masked_;
    gl::Buffer queue_;
    gl::Buffer pairs_;
    gl::Buffer bits_;
    gl::Buffer ranks_;
    gl::Buffer sums_;
    const gl::Buffer* subset_ = nullptr;
    std::vector<std::uint32_t> slice_ranks_;  ///< occupied voxels before each z of the region, and all
};

}  // namespace cairn::voxelizer
