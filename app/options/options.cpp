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

/// A voxel is then 2^8 lattice units wide, which still tells where in it a vertex is.
constexpr int max_grid_resolution = 65536;
constexpr int max_scene_index = 1 << 20;
constexpr const char* common_group = "Common options";

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

gl::ContextKind context_named(const std::string& name) {
    if (name == "auto") return gl::ContextKind::automatic;
    if (name == "osmesa") return gl::ContextKind::osmesa;
    if (name == "egl") return gl::ContextKind::egl;
    throw Error(Fault::usage, "--context", fmt::format("there is no \"{}\"", name),
                "choose auto, osmesa or egl");
}

scenes::Bounds bounds_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--bounds", text, 6, 6);
    const scenes::Bounds bounds{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.low[axis] >= bounds.high[axis]) {
            throw Error(Fault::usage, "--bounds",
                        fmt::format("{0}0 = {1} is not less than {0}1 = {2}", "XYZ"[axis], bounds.low[axis],
                                    bounds.high[axis]),
                        "the order is X0,Y0,Z0,X1,Y1,Z1");
        }
    }
    return bounds;
}

gl::ShaderSource shaders_in(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) {
        throw Error(Fault::usage, "--shader-dir", fmt::format("\"{}\" is not a folder", folder.string()),
                    "name the shaders/ folder of the sources");
    }
    return gl::ShaderSource(folder);
}

}  // namespace

CLI::Option* add_parsed_option(CLI::App& verb, const std::string& name, const std::string& value_name,
                               const std::string& description,
                               const std::function<void(const std::string&)>& parse) {
    return verb.add_option_function<std::string>(name, parse, description)->type_name(value_name);
}

void add_report_options(CLI::App& verb, ReportOptions& options) {
    add_parsed_option(verb, "--json", "FILE", "write every figure as JSON too; - is stdout, without the text",
                      [&options](const std::string& target) {
                          if (target != "-") check_writable(target);
                          options.json = target;
                      })
        ->group(common_group);
    verb.add_flag("--quiet", options.quiet, "print nothing but errors")->group(common_group);
}

void add_scene_argument(CLI::App& verb, SceneOptions& options) {
    verb.add_option("SCENE", options.scene,
                    "a .gltf or .glb file, or builtin:NAME; where the verb\ntakes volumes, a .mha, .mhd, "
                    ".nii or .nii.gz file too")
        ->required()
        ->type_name("");
    verb.add_flag("--trust-paths", options.trust_paths,
                  "let the scene read files outside its own folder: only for\nfiles that you trust")
        ->group(common_group);
}

void add_moment_options(CLI::App& verb, SceneOptions& options) {
    add_parsed_option(
        verb, "--time", "SECONDS",
        "the moment to show (default: the rest pose); plays the\nfirst animation if none is named",
        [&options](const std::string& text) { options.seconds = parse_number("--time", text); })
        ->group(common_group);
    add_parsed_option(verb, "--animation", "NAME|INDEX", "the animation to play, by name or counted from 0",
                      [&options](const std::string& text) { options.animation = text; })
        ->group(common_group);
    add_parsed_option(verb, "--scene-index", "I",
                      "which scene of the file, counted from 0 (default: the\nfile's own choice)",
                      [&options](const std::string& text) {
                          options.scene_index = parse_int("--scene-index", text, 0, max_scene_index);
                      })
        ->group(common_group);
}

void add_driver_options(CLI::App& verb, DriverOptions& options) {
    add_parsed_option(verb, "--context", "auto|osmesa|egl", "where OpenGL comes from (default: auto)",
                      [&options](const std::string& text) { options.context = context_named(text); })
        ->group(common_group);
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

void add_grid_options(CLI::App& verb, GridOptions& options) {
    add_parsed_option(verb, "-r,--resolution", "N|X,Y,Z",
                      fmt::format("voxels along each axis, 1 to {}: a cube, or a number for\neach (then the "
                                  "JSON's resolution is an array of three)",
                                  max_grid_resolution),
                      [&options](const std::string& text) {
                          options.resolution = parse_axes("--resolution", text, 1, max_grid_resolution);
                      });
    add_parsed_option(verb, "--voxel-size", "S",
                      "the side of a voxel in world units, instead of -r: as\nmany voxels along each axis as "
                      "that takes",
                      [&options](const std::string& text) {
                          options.voxel_size = parse_number("--voxel-size", text);
                          if (*options.voxel_size <= 0.0)
                              throw Error(Fault::usage, "--voxel-size",
                                          fmt::format("\"{}\" is not above 0", text));
                      });
    add_parsed_option(verb, "--bounds", "X0,Y0,Z0,X1,Y1,Z1",
                      "the part of the world to cut into voxels: the grid starts\nat its low corner and "
                      "covers it along every "
                      "axis (default:\nwhat leaves an empty voxel on each side of the scene,\ncentred)",
                      [&options](const std::string& text) { options.bounds = bounds_of(text); });
}

void check_grid_options(const GridOptions& options) {
    if (options.resolution && options.voxel_size) {
        throw Error(Fault::usage, "--voxel-size", "cannot go with --resolution",
                    "give the number of voxels or their size");
    }
    if (!options.resolution && !options.voxel_size) {
        throw Error(Fault::usage, "", "--resolution or --voxel-size is required",
                    "-r 256 makes a cube of 256 voxels a side");
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

CLI::Option* add_output_option(CLI::App& verb, std::optional<std::filesystem::path>& output,
                               const std::vector<std::string>& endings, const std::string& description) {
    return add_parsed_option(
        verb, "-o,--output", "FILE", description, [&output, known = endings](const std::string& text) {
            const std::filesystem::path path(text);
            if (!is_device(path) &&
                std::ranges::find(known, lower_case(path.extension().string())) == known.end()) {
                throw Error(Fault::usage, text.empty() ? "--output" : text,
                            fmt::format("no format ends in \"{}\"", path.extension().string()),
                            fmt::format("what this verb writes ends in {}", fmt::join(known, " or ")));
            }
            check_writable(path);
            output = path;
        });
}

void check_writable(const std::filesystem::path& path) {
    if (!is_device(path)) const OutputFile probe(path);
}

}  // namespace cairn::app
