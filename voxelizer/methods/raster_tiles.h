#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// A part of a region that is rasterized at once.
struct RasterTile {
    /// Its low corner, in voxels from the region's; x is a multiple of 32.
    glm::ivec3 place{0};
    glm::ivec3 size{0};         ///< voxels
    glm::ivec3 lattice_low{0};  ///< its low corner in lattice units
    /// The region's high corner, lattice units from the tile's low one.
    glm::ivec3 region_end{0};
    int voxel_shift = 0;  ///< a voxel is 2^voxel_shift lattice units

    /// Texels that the layers of all directions take.
    [[nodiscard]] glm::ivec2 plane(int directions) const;
    [[nodiscard]] int slices(int directions) const;
    /// The layer that looks along x lies so that the longer of y and z goes downwards, as in the other two: a
    /// tall tile does not make all layers wide.
    [[nodiscard]] bool tall() const { return size.y > size.z; }
    [[nodiscard]] int longest_side() const;
};

/// Cuts a region so that each part has at most 1024 slices in each direction that is used, and render targets
/// of at most RASTER_TARGET_MIB. Parts of the region that no vertex of a surface can reach are left out.
/// @param directions  1: along z alone; 3: along x, y and z
[[nodiscard]] std::vector<RasterTile> raster_tiles(const Region& region, int directions);

}  // namespace cairn::voxelizer
