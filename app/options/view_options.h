#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/options/option_table.h"
#include "app/options/options.h"
#include "app/options/transfer_option.h"
#include "renderer/renderer.h"
#include "renderer/view/view.h"
#include "scenes/snapshot.h"

/// Options that `cairn render` and `cairn view` have in common: camera, light, tree, and what is shown.
namespace cairn::app {

constexpr int default_soft_rays = 64;  ///< rays per pixel

struct ViewOptions {
    /// The camera and the light of the view count only if they were given. Its shadow leaves out `cones`.
    renderer::View view;
    /// Soft shadows are computed by cones and not by rays.
    bool cones = false;
    /// Shape and resolution of the tree; none: what suits the scene.
    std::optional<int> tree_n, brick_m, max_resolution;
    renderer::PoolSizes pools;
    renderer::MarchOptions march;
    /// Milliseconds for a frame; none: until nothing is missing.
    std::optional<double> frame_budget_ms;
    bool camera_given = false;
    bool light_given = false;
    std::optional<TransferChoice> transfer;  ///< transfer function of a volume
    int copies = 1;                          ///< copies of a volume per axis
    std::optional<int> steps_per_voxel;      ///< steps of a ray per voxel of a volume
    /// Gradient of a volume from which on it is lit as a surface, in densities per voxel.
    std::optional<double> gradient_threshold;
    int zoom = 0;  ///< log2 of the zoom into builtin:fractal
};

/// Options of the picture, its camera and its light.
[[nodiscard]] OptionTable<ViewOptions> camera_table();
/// Options of the shadows.
[[nodiscard]] OptionTable<ViewOptions> shadow_table();
/// Options of the size of voxels, and of their caches.
[[nodiscard]] OptionTable<ViewOptions> tree_table();
/// Options of the shape of the tree, and of how rays go through it.
[[nodiscard]] OptionTable<ViewOptions> march_table();
/// Options of `cairn render` alone: how a frame asks for tiles, and how long it may take.
[[nodiscard]] OptionTable<ViewOptions> frame_table();
/// Options of what is shown of the voxels, and how.
[[nodiscard]] OptionTable<ViewOptions> look_table();
/// The option `--zoom`, of `cairn render` alone.
[[nodiscard]] OptionTable<ViewOptions> zoom_table();

/// The options that `cairn render` and `cairn view` share: all tables above except frame_table() and
/// zoom_table().
[[nodiscard]] OptionTable<ViewOptions> view_table();

/// The shadow that the options ask for, `cones` included.
[[nodiscard]] renderer::ShadowQuality shadow_of(const ViewOptions& options);

/// The view that the options ask for. If no light was given, it has the light of the scene; if no camera was
/// given, one that sees the whole scene.
/// @throws Error as renderer::check_view() does.
[[nodiscard]] renderer::View view_of(const ViewOptions& options, const scenes::Snapshot& snapshot);

/// The text for `--camera` that means this camera. For a snapped camera it does so bit for bit. The camera's
/// up direction must be the one that `--camera` chooses.
[[nodiscard]] std::string camera_text(const optics::Camera& camera);

/// The nearest camera that the text of `--camera` can express.
[[nodiscard]] optics::Camera snapped(const optics::Camera& camera);

/// A line for the shell that renders this picture again: with the scene, the moment and the tree of the
/// options, and with the view, whose camera must be a snapped one. Options with default values are left out.
[[nodiscard]] std::string render_command(const SceneOptions& scene, const ViewOptions& options,
                                         const renderer::View& view, const std::filesystem::path& output);

}  // namespace cairn::app
