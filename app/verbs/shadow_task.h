#pragma once

#include "app/options/shadow_options.h"
#include "app/subject/scene_input.h"
#include "renderer/renderer.h"
#include "scenes/snapshot.h"

namespace cairn::app {

/// What a shadow is computed from: the chosen nodes, and the view with its light.
struct ShadowTask {
    SceneInput input;
    scenes::NodeSelection occluders, receivers;
    scenes::Snapshot shown;  ///< occluders and receivers
    renderer::View view;
};

/// Voxels per side of the tree or of the pyramid: --max-resolution if it was given, else the default.
[[nodiscard]] int tree_resolution(const ShadowOptions& options);
[[nodiscard]] int pyramid_resolution(const ShadowOptions& options);

/// Loads the scene and chooses nodes, light and view.
/// @throws Error (Fault::usage) if the options contradict each other, before anything is written; as
/// load_input() does.
[[nodiscard]] ShadowTask make_shadow_task(const ShadowOptions& options);

}  // namespace cairn::app
