#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace cairn::scenes {

/// What a file may ask for. A count above one of these limits is an Error that says which limit it is: the
/// file may be genuine, but a few bytes of it could also take all of the machine's memory.
struct Limits {
    std::uint64_t json_bytes = 1ULL << 30;     ///< of JSON text, with the buffers embedded in it
    std::uint64_t json_values = 4'000'000;     ///< values in the JSON; parsing one takes some hundred bytes
    std::uint64_t elements = 1'000'000;        ///< of one array of the JSON: nodes, accessors, ...
    std::uint64_t materials = 20'000;          ///< each takes some kilobytes
    std::uint64_t file_bytes = 1ULL << 32;     ///< of each file
    std::uint64_t image_bytes = 256ULL << 20;  ///< of each unpacked picture
    std::uint64_t primitives = usual_primitives;  ///< places of primitives, one per instance

    friend bool operator==(const Limits&, const Limits&) = default;
};

/// A limit and its name, for those who set limits by name.
struct LimitName {
    std::string_view name;
    std::uint64_t Limits::*value;
};
[[nodiscard]] std::span<const LimitName> limit_names();

struct LoadOptions {
    bool trust_paths = false;  ///< allow URIs that are absolute or leave the file's folder
    /// Throw where a warning would alter what is voxelized or shown (Warning::alters).
    bool strict = false;
    /// Bytes that the unpacked parts of a file may take together: geometry, animation and pictures. What
    /// take_snapshot() places may take as many again (Scene::placing). If nobody says so, these are
    /// usual_memory_bytes, and less for a small file: 64 MiB (192 for pictures, 1024 for what is placed) and
    /// 256 times its size.
    std::optional<std::uint64_t> memory_bytes = std::nullopt;
    Limits limits = {};
};

/// Reads a .gltf or .glb file (glTF 2.0), or generates a built-in scene ("builtin:knot").
///
/// Supported: see docs/gltf.md. An extension in extensionsRequired that is not supported is an error that
/// names it; an optional one is a warning. What glTF forbids and other readers accept is read as they read
/// it, with a warning; so is a picture that cannot be read, unless an alpha mask needs it.
/// @throws Error  Fault::input, naming the file, the element and the fault; Fault::memory if the file would
///                take more than LoadOptions::memory_bytes.
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
