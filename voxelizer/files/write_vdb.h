#pragma once

#include <filesystem>
#include <memory>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Writes OpenVDB's .vdb: a float grid "density" that is 1 in occupied voxels, and 0 and inactive elsewhere.
/// If the tiles have attributes, the file also has vector grids of the same voxels: "Cd", linear base colour,
/// and "N", normals in world space. Values are stored as half floats. Index (i, j, k) is the centre of a
/// voxel, as OpenVDB has it; the grids carry the transform to the world.
///
/// The file is written without the library, which needs the whole tree in memory
/// (docs/decisions/voxelizing.md). Its layout is that of file version 224, as OpenVDB 7 to 12 write it:
/// io/Archive.cc, tree/InternalNode.h, io/Compression.h. Memory: 40 bytes per tile that holds voxels, and one
/// tile. A temporary file holds 64 bytes for each 8^3 voxels that are not empty, and 12 for each voxel with
/// attributes.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_vdb_writer(const std::filesystem::path& path,
                                                           const Grid& grid);

}  // namespace cairn::voxelizer
