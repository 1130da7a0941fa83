#pragma once

#include <optional>

#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {

/// Adds a node named "ground" with a horizontal square, white and facing up, for the shadows of what stands
/// on it. It lies a thousandth of the bounds' longest side under them, around their middle, and is twice as
/// wide as that side is long.
/// @param bounds       of what stands on it; at all times, where it moves. Nothing is added where they are
///                     empty.
/// @param scene_index  of the scenes that the file describes; none: its default scene.
void add_ground(Scene& scene, const Bounds& bounds, std::optional<int> scene_index = std::nullopt);

}  // namespace cairn::scenes
