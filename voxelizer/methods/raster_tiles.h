#pragma once

#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// A part of a region that is rasterized at once.
struct RasterTile {
    /// Low corner, in voxels from the region's low corner; x is a multiple of 32.
    glm::ivec3 place{0};
    glm::ivec3 size{0};         ///< voxels
    glm::ivec3 lattice_low{0};  ///< low corner, lattice units
    /// High corner of the region, in lattice units from the tile's low corner.
    glm::ivec3 region_end{0};
    int voxel_shift = 0;  ///< log2 of a voxel's side in lattice units

    /// Width and height in texels that suffice for the layers of all directions.
    [[nodiscard]] glm::ivec2 plane(int directions) const;
    [[nodiscard]] int slices(int directions) const;
    /// Whether the layer that looks along x has y downwards instead of z. The longer of the two goes
    /// downwards, so that a tall tile does not make all layers wide.
    [[nodiscard]] bool tall() const { return size.y > size.z; }
    [[nodiscard]] int longest_side() const;
};

/// Cuts a region so that each part has at most 1024 slices in each direction that is used, and needs render
/// targets of at most `target_bytes`, or is as small as a part can be. Parts of the region that no vertex of
/// a surface can reach are left out.
/// @param directions  1: along z alone; 3: along x, y and z
[[nodiscard]] std::vector<RasterTile> raster_tiles(const Region& region, int directions,
                                                   std::size_t target_bytes);

}  // namespace cairn::voxelizer
