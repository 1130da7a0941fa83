#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// The endings that make_voxel_writer knows in this build, with their dot: ".npy", ...
[[nodiscard]] std::vector<std::string> voxel_file_endings();

/// A writer for the format that the path's ending names (in upper or lower case).
/// @throws Error  Fault::usage: no such format, or not in this build; says what there is. As OutputFile does;
///                and Fault::usage when the grid passes what the format's numbers can hold.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_voxel_writer(const std::filesystem::path& path,
                                                             const Grid& grid);

}  // namespace cairn::voxelizer
