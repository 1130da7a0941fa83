#pragma once

#include <filesystem>

#include "scenes/scene.h"

namespace cairn::scenes {

/// Writes a scene as a .glb file that glTF validators accept: nodes, meshes, materials and base-colour
/// textures (PNG), lights, cameras and instances. Meshes stay shared. Skins, morph targets and animations are
/// not written: a mesh that they deform is written as its file stores it. Texture transforms are applied to
/// the coordinates.
/// @throws Error if the file cannot be written, or if the scene passes the 4 GiB that a .glb can hold.
void write_glb(const Scene& scene, const std::filesystem::path& path);

}  // namespace cairn::scenes
