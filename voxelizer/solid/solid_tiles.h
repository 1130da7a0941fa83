#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/solid/fill.h"

namespace cairn::voxelizer {

/// Adds the inside of closed meshes to the tiles of voxelize_tiles(), and brings those that hold nothing but
/// inside, in their place in the order.
class SolidTiles {
public:
    /// Refers to the fill, which must outlive it.
    SolidTiles(const SolidFill& fill, const Grid& grid, TileSink sink, int tile_side = VOXEL_TILE_SIDE);

    void add(VoxelTile&& tile);
    /// After the last tile.
    void finish();

    [[nodiscard]] std::uint64_t occupied() const { return occupied_; }

private:
    /// Brings the tiles before that one that hold any inside.
    void skip_to(std::int64_t number);
    void emit(VoxelTile&& tile);

    const SolidFill& fill_;
    glm::ivec3 resolution_;
    glm::ivec3 counts_;
    TileSink sink_;
    int side_;
    std::int64_t next_ = 0;  ///< number of the next tile, in the order of VoxelWriter
    std::uint64_t occupied_ = 0;
};

}  // namespace cairn::voxelizer
