#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace cairn::scenes::gltf {

/// Reads a .gltf or .glb file; what load() does once it knows that it has a file.
/// @throws Error  Fault::input.
[[nodiscard]] Scene read_gltf(const std::filesystem::path& path, bool trust_paths);

}  // namespace cairn::scenes::gltf
