#pragma once

#include "app/options/shadow_options.h"
#include "app/subject/scene_input.h"
#include "renderer/renderer.h"
#include "scenes/node_selection.h"
#include "scenes/snapshot.h"

namespace cairn::app {

/// What a shadow is computed from: the chosen nodes, and the view with its light.
struct ShadowTask {
    SceneInput input;
    scenes::NodeSelection occluders, receivers;
    scenes::Snapshot shown;  ///< of occluders and receivers
    renderer::View view;
};

/// Voxels per side of the tree, and of the pyramid: --max-resolution if it was given.
[[nodiscard]] int tree_resolution(const ShadowOptions& options);
[[nodiscard]] int pyramid_resolution(const ShadowOptions& options);

/// @throws Error (Fault::usage) when the options contradict each other; before anything is written.
[[nodiscard]] ShadowTask make_shadow_task(const ShadowOptions& options);

}  // namespace cairn::app
