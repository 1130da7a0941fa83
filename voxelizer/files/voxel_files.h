#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// The endings of the formats that this build can write, with their dot: ".npy", ...
[[nodiscard]] std::vector<std::string> voxel_file_endings();

/// A writer for the format that the path's ending names (in upper or lower case).
/// @throws Error  Fault::usage if there is no such format in this build (the message lists those there are),
/// or
///                if the grid passes what the format's numbers can hold; and as OutputFile does.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_voxel_writer(const std::filesystem::path& path,
                                                             const Grid& grid);

}  // namespace cairn::voxelizer
