#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/solid/fill.h"

namespace cairn::voxelizer {

/// A sink for voxelize_tiles() that adds the inside of closed meshes to each tile before it goes on to
/// another sink. Tiles of which only the inside is occupied are inserted in their place in the order.
class SolidTiles {
public:
    /// Refers to the fill, which must outlive it.
    SolidTiles(const SolidFill& fill, const Grid& grid, TileSink sink, int tile_side = VOXEL_TILE_SIDE);

    /// Takes the next tile.
    void add(VoxelTile&& tile);
    /// Emits the remaining tiles; to be called after the last add().
    void finish();

    [[nodiscard]] std::uint64_t occupied() const { return occupied_; }

private:
    /// Emits the tiles before that number of which only the inside is occupied.
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
