#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "app/options/options.h"
#include "app/options/transfer_option.h"
#include "renderer/renderer.h"
#include "scenes/snapshot.h"

/// What `cairn render` and `cairn view` have in common: from where to look, at what, through which tree.
namespace cairn::app {

constexpr int max_copies = 4096;
constexpr int default_soft_rays = 64;  ///< a pixel

struct ViewOptions {
    renderer::View view;  ///< camera and light only count when they were given
    renderer::TreeOptions tree;
    bool camera_given = false;
    std::optional<std::string> light;       ///< as it was given
    std::optional<std::string> brick_pool;  ///< likewise
    std::optional<std::string> brick_cache;
    std::optional<TransferChoice> transfer;  ///< of a volume
    int copies = 1;                          ///< of a volume, along each axis
    int zoom = 0;                            ///< of builtin:fractal, a power of two
};
void add_view_options(CLI::App& verb, ViewOptions& options);
void add_camera_options(CLI::App& verb, ViewOptions& options);  ///< of those: picture, camera and light
void add_tree_options(CLI::App& verb, ViewOptions& options);    ///< of those: voxels and their caches

/// The view of the options, with the scene's own light and a camera that sees the whole scene where none was
/// given. @throws Error as renderer::check_view() does.
[[nodiscard]] renderer::View view_of(const ViewOptions& options, const scenes::Snapshot& snapshot);

/// What `--camera` is to be given for this camera: for a snapped one it means the same, bit for bit. Its up
/// direction must be the one that `--camera` chooses.
[[nodiscard]] std::string camera_text(const optics::Camera& camera);

/// The nearest camera that `--camera` can tell.
[[nodiscard]] optics::Camera snapped(const optics::Camera& camera);

/// A line for the shell that makes this picture again: the scene, the moment and the tree of the options, and
/// the view, whose camera is a snapped one.
[[nodiscard]] std::string render_command(const SceneOptions& scene, const ViewOptions& options,
                                         const renderer::View& view, const std::filesystem::path& output);

}  // namespace cairn::app
