#pragma once

#include "app/options/options.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::app {

/// A scene and what stands where at the moment that was asked for. The snapshot points into the scene.
struct SceneInput {
    scenes::Scene scene;
    scenes::Snapshot snapshot;
    scenes::When when;  ///< of the snapshot
};

/// Loads, and warns on stderr unless `quiet`.
/// @throws Error  Fault::input, or Fault::usage when there is no such animation or scene.
[[nodiscard]] SceneInput load_input(const SceneOptions& options, bool quiet);

/// Adds a plane (scenes/ground.h) under all that the animation moves.
void add_ground(SceneInput& input);

}  // namespace cairn::app
