#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelizer.h"
#include "voxelizer/surface/surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::voxelizer {

struct TileOptions {
    int tile_side = VOXEL_TILE_SIDE;  ///< a multiple of 32
    /// Bytes of bits up to which a grid is marked at once (512^3 voxels).
    std::size_t whole_bytes = std::size_t(16) << 20U;
    /// Bytes of bits per region of a larger grid; a region is at least one tile. Regions are parts of slabs
    /// that are one tile wide along x. Measured by `cairn bench region-sizes`: with smaller regions, large
    /// triangles are looked at more often; larger regions gain nothing.
    std::size_t region_bytes = std::size_t(16) << 20U;
    /// Marks the first region twice, and leaves the first run out of the statistics: drivers compile programs
    /// at their first use.
    bool warm_up = false;
};

struct TileStatistics {
    std::uint64_t occupied = 0;  ///< occupied voxels
    std::uint64_t tiles = 0;     ///< tiles with a voxel
    std::uint64_t regions = 0;
    /// Triangles given to the regions, each counted once per region that it meets.
    std::uint64_t triangles = 0;
    /// Sum of Voxelizer::last_milliseconds over all regions.
    double milliseconds = 0.0;
};

/// Takes over a tile that holds at least one voxel; its attributes are empty.
using TileSink = std::function<void(VoxelTile&&)>;
/// Takes the share that is done, in [0, 1], before each region. @return false to stop.
using TileProgress = std::function<bool(double)>;

/// Voxelizes a grid of any size, tile by tile in the order of VoxelWriter, in bounded memory: two regions and
/// one tile beside the surface and its index. Parts of the grid in which the index has no triangle cost
/// nothing.
///
/// @param index  the index of the same surface; the Surface itself is not needed.
/// @throws Error  as Voxelizer::voxelize; Fault::interrupted when `progress` says to stop; whatever `sink`
///                throws.
TileStatistics voxelize_tiles(Voxelizer& voxelizer, const GpuSurface& surface, TriangleIndex& index,
                              const Grid& grid, const TileSink& sink, const TileProgress& progress = {},
                              const TileOptions& options = {});

/// Tiles along each axis of a grid.
[[nodiscard]] inline glm::ivec3 tile_counts(const Grid& grid, int tile_side = VOXEL_TILE_SIDE) {
    return (grid.resolution - 1) / tile_side + 1;
}

}  // namespace cairn::voxelizer
