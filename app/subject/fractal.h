#pragma once

#include "app/options/options.h"
#include "app/options/view_options.h"
#include "renderer/renderer.h"

/// The built-ins that are sets known by a formula: `builtin:fractal`, which has no finest level, and
/// `builtin:sponge`, in a tree of N = 3.
namespace cairn::app {

[[nodiscard]] bool is_fractal(const SceneOptions& scene);

[[nodiscard]] bool is_sponge(const SceneOptions& scene);

/// As deep as trees can be.
/// @throws Error (Fault::usage) when a resolution was given too.
[[nodiscard]] renderer::TreeOptions fractal_tree(const ViewOptions& options);

/// As fine as rays can count, unless another resolution was given.
[[nodiscard]] renderer::TreeOptions sponge_tree(const ViewOptions& options);

/// `--camera` and `--light` tell places from the middle of the fractal, in units of its side / 2^zoom.
[[nodiscard]] renderer::View fractal_view(const ViewOptions& options, int zoom);

}  // namespace cairn::app
