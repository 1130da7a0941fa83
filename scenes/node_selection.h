#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::scenes {

/// One flag per node of Scene::nodes.
using NodeSelection = std::vector<bool>;

/// The nodes that `wanted` names, with their descendants. A text that is a name selects all nodes of that
/// name; else a whole number is an index into Scene::nodes.
/// @throws Error  Fault::usage if a text is neither; the way out lists the nodes.
[[nodiscard]] NodeSelection select_nodes(const Scene& scene, std::span<const std::string> wanted);

/// All nodes that are not selected.
[[nodiscard]] NodeSelection other_nodes(const NodeSelection& selection);

/// The items of the selected nodes, with their bounds and counts, without lights and cameras. The whole
/// snapshot must outlive the part, whose items point into the same vertices.
[[nodiscard]] Snapshot part_of(const Snapshot& whole, const NodeSelection& selection);

}  // namespace cairn::scenes
