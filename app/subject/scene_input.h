#pragma once

#include <span>

#include "app/options/options.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::app {

/// A scene, and its snapshot at the moment that was asked for. The snapshot points into the scene.
struct SceneInput {
    scenes::Scene scene;
    scenes::Snapshot snapshot;
    scenes::When when;  ///< moment of the snapshot
};

/// Loads a scene, and prints its warnings (warn_of()).
/// @throws Error  Fault::input if the file is bad; Fault::usage if there is no such animation or scene.
[[nodiscard]] SceneInput load_input(const SceneOptions& options, bool quiet);

/// Prints a file's warnings on stderr; if `quiet`, only those that alter what is voxelized or shown.
void warn_of(std::span<const scenes::Warning> warnings, bool quiet);

/// Adds a plane (scenes/ground.h) under the scene and all places that its animation moves it to.
void add_ground(SceneInput& input);

}  // namespace cairn::app
