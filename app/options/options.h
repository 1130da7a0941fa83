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
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "voxelizer/grid.h"

/// Options that verbs have in common. An `add_...` function adds options to a verb; once the command line has
/// been read, their values are in its second argument.
namespace cairn::app {

/// Where the figures of a run go.
struct ReportOptions {
    /// The file for the JSON; "-": stdout, which then holds nothing else.
    std::optional<std::string> json;
    bool quiet = false;
};
void add_report_options(CLI::App& verb, ReportOptions& options);

/// Which scene is read, and at which moment of it.
struct SceneOptions {
    std::string scene;  ///< a path or "builtin:NAME"
    scenes::LoadOptions load;
    std::optional<double> seconds;
    std::optional<std::string> animation;  ///< a name or an index
    std::optional<int> scene_index;
};
[[nodiscard]] OptionTable<SceneOptions> moment_table();
/// The options of how a file is read: `--trust-paths`, `--strict`, `--memory` and `--limit`.
[[nodiscard]] OptionTable<SceneOptions> load_table();
/// Adds the argument `SCENE` and the options of load_table().
void add_scene_argument(CLI::App& verb, SceneOptions& options);
void add_moment_options(CLI::App& verb, SceneOptions& options);

/// Which driver and which shaders are used.
struct DriverOptions {
    gl::ContextKind context = gl::ContextKind::automatic;
    gl::ShaderSource shaders;
};
void add_driver_options(CLI::App& verb, DriverOptions& options);
/// Adds the option of the shaders alone, for a verb with a window.
void add_shader_option(CLI::App& verb, DriverOptions& options);

/// The options of every verb that reads a scene at a moment.
struct CommonOptions {
    ReportOptions report;
    SceneOptions scene;
    DriverOptions driver;
};
void add_common_options(CLI::App& verb, CommonOptions& options);

/// Which grid is voxelized. After check_grid_options() exactly one of `resolution` and `voxel_size` is set.
struct GridOptions {
    std::optional<glm::ivec3> resolution;
    std::optional<double> voxel_size;
    std::optional<scenes::Bounds> bounds;
};
[[nodiscard]] OptionTable<GridOptions> grid_table();
/// @throws Error (Fault::usage) if neither or both of `resolution` and `voxel_size` are set.
void check_grid_options(const GridOptions& options);
[[nodiscard]] voxelizer::Grid make_grid(const GridOptions& options, const scenes::Bounds& scene);

/// The word for the value, in the help, of every option that names a file to write, and of no other.
inline constexpr const char* output_file = "FILE";

/// Adds an option that names a file to write. FILE must end in one of `endings` (".npy").
CLI::Option* add_file_option(CLI::App& verb, const std::string& name,
                             std::optional<std::filesystem::path>& output,
                             const std::vector<std::string>& endings, const std::string& description);
/// Adds the option `-o FILE`.
CLI::Option* add_output_option(CLI::App& verb, std::optional<std::filesystem::path>& output,
                               const std::vector<std::string>& endings, const std::string& description);

/// Whether the path is a device or a pipe. It needs no ending, and it must not be opened just to check it:
/// the reader of a pipe would notice.
[[nodiscard]] bool is_device(const std::filesystem::path& path);

/// Checks before any work that a file can be written at the path. Leaves no file behind.
/// @throws Error (Fault::usage) if it cannot be written.
void check_writable(const std::filesystem::path& path);

}  // namespace cairn::app
