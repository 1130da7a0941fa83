#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {

/// One flag a node of Scene::nodes.
using NodeSelection = std::vector<bool>;

/// The nodes that `wanted` names, with all that hangs under them. A text that is the name of nodes means all
/// of them; else a whole number is an index into Scene::nodes.
/// @throws Error  Fault::usage when a text is neither; the way out lists the nodes.
[[nodiscard]] NodeSelection select_nodes(const Scene& scene, std::span<const std::string> wanted);

/// All nodes that are not selected.
[[nodiscard]] NodeSelection other_nodes(const NodeSelection& selection);

/// The items of the selected nodes, with bounds and counts of their own; no lights, no cameras. The whole
/// snapshot must outlive it, for its items point where the whole's do.
[[nodiscard]] Snapshot part_of(const Snapshot& whole, const NodeSelection& selection);

}  // namespace cairn::scenes
