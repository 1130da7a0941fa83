#pragma once

#include <string>

#include "scenes/scene.h"

namespace cairn::scenes {

struct LoadOptions {
    bool trust_paths = false;  ///< allow URIs that are absolute or leave the file's folder
};

/// Reads a .gltf or .glb file (glTF 2.0), or generates a built-in scene ("builtin:knot").
///
/// Supported: see docs/gltf.md. An extension in extensionsRequired that is not supported is an error that
/// names it; an optional one is a warning.
/// @throws Error  Fault::input, naming the file, the element and the fault.
[[nodiscard]] Scene load(const std::string& path_or_builtin, const LoadOptions& options = {});

}  // namespace cairn::scenes
