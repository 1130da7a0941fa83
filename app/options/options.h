#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/options/option_table.h"
#include "gl/context.h"
#include "gl/shader_source.h"
#include "scenes/snapshot.h"
#include "voxelizer/grid.h"

/// What verbs have in common on the command line. An `add_...` function teaches options to a verb; they are
/// stored where its second argument points when the command line has been read.
namespace cairn::app {

/// Where the figures go.
struct ReportOptions {
    std::optional<std::string> json;  ///< a file, or "-": stdout, and nothing else there
    bool quiet = false;
};
void add_report_options(CLI::App& verb, ReportOptions& options);

/// Which scene, and at which moment.
struct SceneOptions {
    std::string scene;  ///< a path or "builtin:NAME"
    bool trust_paths = false;
    std::optional<double> seconds;
    std::optional<std::string> animation;  ///< a name or an index
    std::optional<int> scene_index;
};
[[nodiscard]] OptionTable<SceneOptions> moment_table();
/// `--trust-paths`.
[[nodiscard]] OptionTable<SceneOptions> trust_table();
/// `SCENE` and `--trust-paths`.
void add_scene_argument(CLI::App& verb, SceneOptions& options);
void add_moment_options(CLI::App& verb, SceneOptions& options);

/// Which driver and which shaders.
struct DriverOptions {
    gl::ContextKind context = gl::ContextKind::automatic;
    gl::ShaderSource shaders;
};
void add_driver_options(CLI::App& verb, DriverOptions& options);
/// The shaders alone, for a verb with a window.
void add_shader_option(CLI::App& verb, DriverOptions& options);

/// The options that every verb that reads a scene at a moment understands.
struct CommonOptions {
    ReportOptions report;
    SceneOptions scene;
    DriverOptions driver;
};
void add_common_options(CLI::App& verb, CommonOptions& options);

/// Which voxels: exactly one of resolution and voxel_size, once check_grid_options has passed.
struct GridOptions {
    std::optional<glm::ivec3> resolution;
    std::optional<double> voxel_size;
    std::optional<scenes::Bounds> bounds;
};
[[nodiscard]] OptionTable<GridOptions> grid_table();
/// @throws Error (Fault::usage) when they do not say how fine the grid is, or say it twice.
void check_grid_options(const GridOptions& options);
[[nodiscard]] voxelizer::Grid make_grid(const GridOptions& options, const scenes::Bounds& scene);

/// `-o FILE`, which must end in one of `endings` (".npy").
CLI::Option* add_output_option(CLI::App& verb, std::optional<std::filesystem::path>& output,
                               const std::vector<std::string>& endings, const std::string& description);

/// A device or a pipe: it needs no ending, and opening it only to look would be felt at its other end.
[[nodiscard]] bool is_device(const std::filesystem::path& path);

/// Fails now, before any work, when a file cannot be written there. Leaves no trace.
/// @throws Error (Fault::usage)
void check_writable(const std::filesystem::path& path);

}  // namespace cairn::app
