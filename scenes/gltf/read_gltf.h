#pragma once

#include <filesystem>

#include "scenes/load.h"

namespace cairn::scenes::gltf {

/// Reads a .gltf or .glb file: load() for paths that are not built-in scenes.
/// @throws Error  as load().
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace cairn::scenes::gltf
