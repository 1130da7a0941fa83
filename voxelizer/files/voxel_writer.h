#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Voxels along each side of a tile; fewer at the grid's high ends. A grid is written tile by tile, so that a
/// file may hold more voxels than memory can.
constexpr int VOXEL_TILE_SIDE = 128;

/// Attributes of voxels: one entry per occupied voxel of a tile, in the order of BitGrid::words (x runs
/// fastest, then y, then z). Empty if they are not wanted.
struct VoxelAttributes {
    std::vector<glm::vec3> colors;   ///< linear base colours, [0, 1]
    std::vector<glm::vec3> normals;  ///< unit, world space; 0 if the parts cancel
};

struct VoxelTile {
    glm::ivec3 origin{0};  ///< voxel of the grid, a multiple of VOXEL_TILE_SIDE
    BitGrid bits;
    VoxelAttributes attributes;
};

/// Writes the voxels of one grid to one file.
///
/// Tiles must be added in ascending order of origin.x, then z, then y, each at most once; tiles without
/// voxels may be left out. The file appears, whole, at finish(); without finish() there is no file.
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
    /// What programs that read the file will not show of it; empty: they show all. After finish().
    [[nodiscard]] virtual std::string warning() const { return {}; }

protected:
    VoxelWriter() = default;
};

/// The endings of the formats that this build can write, with their dot: ".npy", ...
[[nodiscard]] std::vector<std::string> voxel_file_endings();

/// A writer for the format that the path's ending names (in upper or lower case).
/// @throws Error  Fault::usage if there is no such format in this build (the message lists those there are),
///                or if the grid passes what the format's numbers can hold; and as OutputFile does.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_voxel_writer(const std::filesystem::path& path,
                                                             const Grid& grid);

}  // namespace cairn::voxelizer
