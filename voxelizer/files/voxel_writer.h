#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"

namespace cairn::voxelizer {

/// A grid is written tile by tile, so that a file may hold more voxels than memory: voxels along each side of
/// a tile, less at the grid's high ends.
constexpr int VOXEL_TILE_SIDE = 128;

/// What a voxel carries beside its bit: one entry per occupied voxel of a tile, in the order of
/// BitGrid::words (x runs fastest, then y, then z). Empty if not asked for.
struct VoxelAttributes {
    std::vector<glm::vec3> colors;   ///< linear base colour, each in [0, 1]
    std::vector<glm::vec3> normals;  ///< world space, of length 1; 0 where the parts cancel
};

struct VoxelTile {
    glm::ivec3 origin{0};  ///< voxel of the grid, a multiple of VOXEL_TILE_SIDE
    BitGrid bits;
    VoxelAttributes attributes;
};

/// Writes the voxels of one grid to one file.
///
/// Tiles come in ascending order of origin.x, then z, then y; each at most once; those without voxels need
/// not come. What was added is in the file, whole, after finish(); without it nothing stays behind.
class VoxelWriter {
public:
    virtual ~VoxelWriter() = default;
    VoxelWriter(const VoxelWriter&) = delete;
    VoxelWriter(VoxelWriter&&) = delete;
    VoxelWriter& operator=(const VoxelWriter&) = delete;
    VoxelWriter& operator=(VoxelWriter&&) = delete;

    [[nodiscard]] virtual bool wants_attributes() const { return false; }
    /// @throws Error as OutputFile does, or Fault::memory.
    virtual void add(const VoxelTile& tile) = 0;
    virtual void finish() = 0;

protected:
    VoxelWriter() = default;
};

}  // namespace cairn::voxelizer
