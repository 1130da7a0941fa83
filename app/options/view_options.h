#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/options/option_table.h"
#include "app/options/options.h"
#include "app/options/transfer_option.h"
#include "renderer/renderer_options.h"
#include "renderer/view/view.h"
#include "scenes/snapshot.h"

/// What `cairn render` and `cairn view` have in common: from where to look, at what, through which tree.
namespace cairn::app {

constexpr int default_soft_rays = 64;  ///< per pixel

struct ViewOptions {
    /// Its camera and its light count only if they were given, and its shadow is that without `cones`.
    renderer::View view;
    /// The rays of soft shadows are cones.
    bool cones = false;
    /// Of the tree; none: what suits the scene.
    std::optional<int> tree_n, brick_m, max_resolution;
    renderer::PoolSizes pools;
    renderer::MarchOptions march;
    /// Of a frame; none: until nothing is missing.
    std::optional<double> frame_budget_ms;
    bool camera_given = false;
    bool light_given = false;
    std::optional<TransferChoice> transfer;  ///< of a volume
    int copies = 1;                          ///< of a volume, along each axis
    std::optional<int> steps_per_voxel;      ///< of rays through a volume
    /// Of a volume, in densities per voxel.
    std::optional<double> gradient_threshold;
    int zoom = 0;  ///< of builtin:fractal, a power of two
};

/// The picture, its camera and its light.
[[nodiscard]] OptionTable<ViewOptions> camera_table();
/// Shadows of that light.
[[nodiscard]] OptionTable<ViewOptions> shadow_table();
/// The size of voxels, and their caches.
[[nodiscard]] OptionTable<ViewOptions> tree_table();
/// The shape of the tree, and how rays go through it.
[[nodiscard]] OptionTable<ViewOptions> march_table();
/// How a frame asks for tiles and how long it may take, for `cairn render` alone.
[[nodiscard]] OptionTable<ViewOptions> frame_table();
/// What is shown of the voxels, and how.
[[nodiscard]] OptionTable<ViewOptions> look_table();
/// `--zoom`, for `cairn render` alone.
[[nodiscard]] OptionTable<ViewOptions> zoom_table();

/// The options that `cairn render` and `cairn view` share: the tables above but the two for `cairn render`.
[[nodiscard]] OptionTable<ViewOptions> view_table();

/// The shadow of the options, cones or not.
[[nodiscard]] renderer::ShadowQuality shadow_of(const ViewOptions& options);

/// The view of the options, with the scene's own light and a camera that sees the whole scene where none was
/// given. @throws Error as renderer::check_view() does.
[[nodiscard]] renderer::View view_of(const ViewOptions& options, const scenes::Snapshot& snapshot);

/// What `--camera` is to be given for this camera: for a snapped one it means the same, bit for bit. Its up
/// direction must be the one that `--camera` chooses.
[[nodiscard]] std::string camera_text(const optics::Camera& camera);

/// The nearest camera that `--camera` can tell.
[[nodiscard]] optics::Camera snapped(const optics::Camera& camera);

/// A line for the shell that makes this picture again: the scene, the moment and the tree of the options, and
/// the view, whose camera is a snapped one. Options that have their default value are left out.
[[nodiscard]] std::string render_command(const SceneOptions& scene, const ViewOptions& options,
                                         const renderer::View& view, const std::filesystem::path& output);

}  // namespace cairn::app
