#pragma once

#include <filesystem>
#include <memory>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// Writes MagicaVoxel's .vox, version 150, with its scene graph (github.com/ephtracy/voxel-model): models of
/// at most 256^3 voxels, and a palette of at most 255 sRGB colours made from the voxels' base colours; light
/// grey if the voxels have no colours.
///
/// Its z axis points up where glTF's y does: the scene is turned by a quarter about x, so that it stands
/// upright. Voxel (i, j, k) of the grid lies at (i, Z - 1 - k, j) - (X / 2, Z / 2, 0), halves rounded down,
/// in the editor's scene; a grid of more than 1000 voxels upwards sinks by Y / 2, so that it lies around the
/// middle along every axis. The format has no place for the grid's origin and the voxel size: they are in the
/// name of the scene's root, as "cairn X Y Z, origin X Y Z, voxel S".
///
/// MagicaVoxel shows places from -1000 to 999 along each axis. Other readers take more, and so does this
/// writer, whose warning() counts the voxels that MagicaVoxel leaves out.
///
/// Memory: one tile, 32 bytes per tile that holds voxels, and a ColorPalette. A temporary file holds 6 bytes
/// per voxel.
/// @throws Error  Fault::usage, from add(), if the file would pass 2 GiB (about 500 million voxels), where
///                the format's sizes end.
[[nodiscard]] std::unique_ptr<VoxelWriter> make_vox_writer(const std::filesystem::path& path,
                                                           const Grid& grid);

}  // namespace cairn::voxelizer
