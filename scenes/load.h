#pragma once
#include <span>
#include <string>
#include <string_view>

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

struct Builtin {
    std::string_view name;
    std::string_view description;
};

/// The scenes that need no file: "knot" (trefoil tube, 52,992 triangles), "spheres" (9 x 9 spheres, 6,848),
/// "tree" (about 600k), "tree-leaves" (the same with alpha-masked leaf cards), "cornell" (the Cornell box),
/// "needles" (3,000 slivers, a trial for voxelizers).
/// The first three stand for the test scenes of Forest et al. 2009, Figure 5.
///
/// All are a few metres across, centred at the origin, and the same on every machine: integers alone decide
/// which triangles there are, and coordinates differ at most by what the last bit of a sine changes.
[[nodiscard]] std::span<const Builtin> builtins();

/// @throws Error (Fault::usage) if no scene has that name; the message lists the names.
[[nodiscard]] Scene make_builtin(std::string_view name);

}  // namespace cairn::scenes
