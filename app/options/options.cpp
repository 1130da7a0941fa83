#include "app/options/options.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/options/parse.h"
#include "base/error.h"
#include "base/output_file.h"

namespace cairn::app {
namespace {

/// A voxel is then 2^8 lattice units wide, which leaves 8 bits for a vertex within its voxel.
constexpr int max_grid_resolution = 65536;
constexpr int max_scene_index = 1 << 20;
constexpr const char* common_group = "Common options";

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

Names<gl::ContextKind> context_names() {
    using gl::ContextKind;
    return {{"auto", ContextKind::automatic}, {"osmesa", ContextKind::osmesa}, {"egl", ContextKind::egl}};
}

OptionTable<DriverOptions> context_table() {
    return {named_row<DriverOptions>(
        "--context", "where OpenGL comes from (default: {default})", context_names(),
        [](auto& options) -> auto& { return options.context; })};
}

scenes::Bounds bounds_of(const char* option, const std::string& text) {
    const std::vector<double> n = parse_numbers(option, text, 6, 6);
    const scenes::Bounds bounds{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.low[axis] >= bounds.high[axis]) {
            throw Error(Fault::usage, option,
                        fmt::format("{0}0 = {1} is not less than {0}1 = {2}", "XYZ"[axis], bounds.low[axis],
                                    bounds.high[axis]),
                        "the order is X0,Y0,Z0,X1,Y1,Z1");
        }
    }
    return bounds;
}

/// Reads "elements=1000000,primitives=8000000".
void set_limits(const char* option, std::string_view text, scenes::Limits& limits) {
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        const std::string_view part = text.substr(0, comma);
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
        const std::size_t equals = part.find('=');
        const auto names = scenes::limit_names();
        const auto found = std::ranges::find(names, part.substr(0, equals), &scenes::LimitName::name);
        if (equals == std::string_view::npos || found == names.end()) {
            std::string known;
            for (const scenes::LimitName& limit : names)
                known += fmt::format("{}{}", known.empty() ? "" : ", ", limit.name);
            throw Error(Fault::usage, option, fmt::format("\"{}\" is no limit and its number", part),
                        "write NAME=N with one of " + known);
        }
        limits.*found->value = parse_count(option, part.substr(equals + 1));
    }
}

/// The names of all limits, for the help.
std::string listed_limits() {
    constexpr std::size_t longest_line = 58;
    std::string text;
    std::string line;
    for (const scenes::LimitName& limit : scenes::limit_names()) {
        if (line.empty() || line.size() + limit.name.size() + 2 > longest_line) {
            text += line.empty() ? "" : line + ",";
            line = "\n" + std::string(limit.name);
        } else {
            line += fmt::format(", {}", limit.name);
        }
    }
    return text + line;
}

/// The limits that are not the usual ones, as set_limits() reads them.
std::string limits_text(const scenes::Limits& limits) {
    std::string text;
    for (const scenes::LimitName& limit : scenes::limit_names())
        if (limits.*limit.value != scenes::Limits{}.*limit.value)
            text += fmt::format("{}{}={}", text.empty() ? "" : ",", limit.name, limits.*limit.value);
    return text;
}

gl::ShaderSource shaders_in(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) {
        throw Error(Fault::usage, "--shader-dir", fmt::format("\"{}\" is not a folder", folder.string()),
                    "name the shaders/ folder of the sources");
    }
    return gl::ShaderSource(folder);
}

}  // namespace

void add_report_options(CLI::App& verb, ReportOptions& options) {
    add_parsed_option(verb, "--json", output_file,
                      "write every figure as JSON too; - is stdout, without the text",
                      [&options](const std::string& target) {
                          if (target != "-") check_writable(target);
                          options.json = target;
                      })
        ->group(common_group);
    verb.add_flag("--quiet", options.quiet,
                  "print nothing but errors, and warnings that what is\nvoxelized or shown is not what the "
                  "file means")
        ->group(common_group);
}

void add_scene_argument(CLI::App& verb, SceneOptions& options) {
    verb.add_option("SCENE", options.scene,
                    "a .gltf or .glb file, or builtin:NAME; where the verb\ntakes volumes, a .mha, .mhd, "
                    ".nii or .nii.gz file too")
        ->required()
        ->type_name("");
    add_table(verb, load_table(), options, common_group);
}

OptionTable<SceneOptions> load_table() {
    return {
        flag_row<SceneOptions>(
            "--trust-paths",
            "let the scene read files outside its own folder: only for\nfiles that you trust",
            [](auto& options) -> auto& { return options.load.trust_paths; }),
        flag_row<SceneOptions>(
            "--strict",
            "fail where a warning would say that what is voxelized or\nshown is not what the file means: a "
            "lost "
            "picture, say",
            [](auto& options) -> auto& { return options.load.strict; }),
        {"--memory", "MIB",
         fmt::format(
             "what the unpacked parts of a file may take together, and\nwhat is made of them as much again "
             "(default: {}, and less\nfor small files)",
             scenes::usual_memory_bytes >> 20U),
         [](SceneOptions& options, const char* option, const std::string& text) {
             constexpr int most_mib = 1 << 24;
             options.load.memory_bytes = std::uint64_t(parse_int(option, text, 1, most_mib)) << 20U;
         },
         [](const SceneOptions& options) -> std::optional<std::string> {
             if (!options.load.memory_bytes) return std::nullopt;
             return std::to_string(*options.load.memory_bytes >> 20U);
         }},
        {"--limit", "NAME=N,...", "allow a file more than usual of these:" + listed_limits(),
         [](SceneOptions& options, const char* option, const std::string& text) {
             set_limits(option, text, options.load.limits);
         },
         [](const SceneOptions& options) -> std::optional<std::string> {
             const std::string text = limits_text(options.load.limits);
             return text.empty() ? std::nullopt : std::optional(text);
         }},
    };
}

OptionTable<SceneOptions> moment_table() {
    return {
        {"--time", "SECONDS",
         "the moment to show (default: the rest pose); plays the\nfirst animation if none is named",
         [](SceneOptions& options, const char* option, const std::string& text) {
             options.seconds = parse_number(option, text);
         },
         [](const SceneOptions& options) -> std::optional<std::string> {
             if (!options.seconds) return std::nullopt;
             return fmt::format("{}", *options.seconds);
         }},
        text_row<SceneOptions>(
            "--animation", "NAME|INDEX", "the animation to play, by name or counted from 0",
            [](auto& options) -> auto& { return options.animation; }),
        whole_row<SceneOptions>(
            "--scene-index", "I", "which scene of the file, counted from 0 (default: the\nfile's own choice)",
            0, max_scene_index, [](auto& options) -> auto& { return options.scene_index; }),
    };
}

void add_moment_options(CLI::App& verb, SceneOptions& options) {
    add_table(verb, moment_table(), options, common_group);
}

void add_driver_options(CLI::App& verb, DriverOptions& options) {
    add_table(verb, context_table(), options, common_group);
    add_shader_option(verb, options);
}

void add_shader_option(CLI::App& verb, DriverOptions& options) {
    add_parsed_option(verb, "--shader-dir", "DIR", "read the shaders from a folder, not the built-in copies",
                      [&options](const std::string& text) { options.shaders = shaders_in(text); })
        ->group(common_group);
}

void add_common_options(CLI::App& verb, CommonOptions& options) {
    add_scene_argument(verb, options.scene);
    add_moment_options(verb, options.scene);
    add_driver_options(verb, options.driver);
    add_report_options(verb, options.report);
}

OptionTable<GridOptions> grid_table() {
    return {
        {"-r,--resolution", "N|X,Y,Z",
         fmt::format("voxels along each axis, 1 to {}: a cube, or a number for\neach (then the JSON's "
                     "resolution is an array of three)",
                     max_grid_resolution),
         [](GridOptions& options, const char* option, const std::string& text) {
             options.resolution = parse_axes(option, text, 1, max_grid_resolution);
         },
         [](const GridOptions& options) -> std::optional<std::string> {
             if (!options.resolution) return std::nullopt;
             const glm::ivec3& axes = *options.resolution;
             if (axes == glm::ivec3(axes.x)) return std::to_string(axes.x);
             return fmt::format("{},{},{}", axes.x, axes.y, axes.z);
         }},
        {"--voxel-size", "S",
         "the side of a voxel in world units, instead of -r: as\nmany voxels along each axis as that takes",
         [](GridOptions& options, const char* option, const std::string& text) {
             const double size = parse_number(option, text);
             if (size <= 0.0) throw Error(Fault::usage, option, fmt::format("\"{}\" is not above 0", text));
             options.voxel_size = size;
         },
         [](const GridOptions& options) -> std::optional<std::string> {
             if (!options.voxel_size) return std::nullopt;
             return fmt::format("{}", *options.voxel_size);
         }},
        {"--bounds", "X0,Y0,Z0,X1,Y1,Z1",
         "the part of the world to cut into voxels: the grid starts\nat its low corner and covers it along "
         "every axis (default:\nwhat leaves an empty voxel on each side of the scene,\ncentred)",
         [](GridOptions& options, const char* option, const std::string& text) {
             options.bounds = bounds_of(option, text);
         },
         [](const GridOptions& options) -> std::optional<std::string> {
             if (!options.bounds) return std::nullopt;
             const auto& [low, high] = *options.bounds;
             return fmt::format("{},{},{},{},{},{}", low.x, low.y, low.z, high.x, high.y, high.z);
         }},
    };
}

void check_grid_options(const GridOptions& options) {
    if (options.resolution && options.voxel_size) {
        throw Error(Fault::usage, "--voxel-size", "cannot go with --resolution",
                    "give the number of voxels or their size");
    }
    if (!options.resolution && !options.voxel_size) {
        throw Error(Fault::usage, "", "--resolution or --voxel-size is required",
                    "-r 256 makes a cube of 256 voxels per side");
    }
}

voxelizer::Grid make_grid(const GridOptions& options, const scenes::Bounds& scene) {
    if (options.resolution) {
        return options.bounds ? voxelizer::grid_over(*options.bounds, *options.resolution)
                              : voxelizer::grid_around(scene, *options.resolution);
    }
    return options.bounds
               ? voxelizer::grid_of_voxels_over(*options.bounds, *options.voxel_size, max_grid_resolution)
               : voxelizer::grid_of_voxels_around(scene, *options.voxel_size, max_grid_resolution);
}

bool is_device(const std::filesystem::path& path) {
    const std::filesystem::file_status there = std::filesystem::status(path);
    return std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
           !std::filesystem::is_directory(there);
}

CLI::Option* add_file_option(CLI::App& verb, const std::string& name,
                             std::optional<std::filesystem::path>& output,
                             const std::vector<std::string>& endings, const std::string& description) {
    const std::string long_name = name.substr(name.rfind("--"));
    return add_parsed_option(
        verb, name, output_file, description, [&output, known = endings, long_name](const std::string& text) {
            const std::filesystem::path path(text);
            if (!is_device(path) &&
                std::ranges::find(known, lower_case(path.extension().string())) == known.end()) {
                throw Error(Fault::usage, text.empty() ? long_name : text,
                            fmt::format("no format ends in \"{}\"", path.extension().string()),
                            fmt::format("what this verb writes ends in {}", fmt::join(known, " or ")));
            }
            check_writable(path);
            output = path;
        });
}

CLI::Option* add_output_option(CLI::App& verb, std::optional<std::filesystem::path>& output,
                               const std::vector<std::string>& endings, const std::string& description) {
    return add_file_option(verb, "-o,--output", output, endings, description);
}

void check_writable(const std::filesystem::path& path) {
    if (!is_device(path)) const OutputFile probe(path);
}

}  // namespace cairn::app
