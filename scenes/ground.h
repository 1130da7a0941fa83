#pragma once

#include <optional>

#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {

/// Adds a node named "ground": a horizontal square, white and facing up, for the shadows of the things that
/// stand on it. The square is twice as wide as the longest side of their bounds, and lies under their middle,
/// a thousandth of that side below them.
/// @param bounds       bounds of the things that stand on the ground, over all times if they move. If they
/// are empty, nothing is added.
/// @param scene_index  which of the file's scenes gets the ground; none: its default scene.
void add_ground(Scene& scene, const Bounds& bounds, std::optional<int> scene_index = std::nullopt);

}  // namespace cairn::scenes
