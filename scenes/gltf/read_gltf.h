#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// Reads a .gltf or .glb file: load() for paths that are not built-in scenes.
/// @throws Error  Fault::input, as load().
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path, bool trust_paths);

}  // namespace cairn::scenes::gltf
