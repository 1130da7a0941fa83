#include "app/options/shadow_options.h"

#include <utility>

#include <fmt/format.h>

#include "app/options/parse.h"
#include "base/error.h"
#include "renderer/shadow/shadow_frustum.h"
#include "shaders/interop/shadow_rays.h"

namespace cairn::app {
namespace {

constexpr int max_map_size = 2048;
constexpr int max_truth_samples = 65536;

template <typename Value>
using Names = std::vector<std::pair<const char*, Value>>;

/// Which of the names was given.
template <typename Value>
Value named(const char* option, const std::string& text, const Names<Value>& names) {
    std::string known;
    for (const auto& [name, value] : names) {
        if (text == name) return value;
        known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
    }
    throw Error(Fault::usage, option, fmt::format("there is no \"{}\"", text),
                fmt::format("choose of {}", known));
}

double positive(const char* option, double value) {
    if (value > 0.0) return value;
    throw Error(Fault::usage, option, fmt::format("{} is not positive", value));
}

optics::Light direction_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--light-direction", text, 3, 4);
    optics::Light light{.towards = {n[0], n[1], n[2]}};
    if (!(glm::length(light.towards) > 0.0))
        throw Error(Fault::usage, "--light-direction", "it is no direction");
    const double degrees = n.size() == 4 ? n[3] : 0.0;
    if (!(degrees >= 0.0 && degrees < 89.9))
        throw Error(Fault::usage, "--light-direction", fmt::format("an angle of {} degrees", degrees),
                    "choose 0 to 89, from the light's middle to its edge");
    light.angle = glm::radians(degrees);
    return light;
}

void add_light_options(CLI::App& verb, ShadowOptions& options) {
    add_parsed_option(verb, "--light-direction", "X,Y,Z[,ANGLE]",
                      "a light that far away, and the degrees from its middle to\nits edge",
                      [&](const std::string& text) { options.direction = direction_of(text); });
    add_parsed_option(verb, "--light-size", "W,H", "makes --light a rectangle", [&](const std::string& text) {
        const std::vector<double> n = parse_numbers("--light-size", text, 2, 2);
        options.rectangle = {positive("--light-size", n[0]), positive("--light-size", n[1])};
    });
    add_parsed_option(verb, "--light-disk", "RADIUS", "makes --light a disk", [&](const std::string& text) {
        options.disk = positive("--light-disk", parse_number("--light-disk", text));
    });
    add_parsed_option(verb, "--light-target", "X,Y,Z",
                      "what a rectangle or a disk shines on (default: the\nscene's middle)",
                      [&](const std::string& text) {
                          const std::vector<double> n = parse_numbers("--light-target", text, 3, 3);
                          options.target = {n[0], n[1], n[2]};
                      });
    add_parsed_option(
        verb, "--rays", "N",
        fmt::format(
            "rays to the light, a pixel; 1 goes to its middle (default:\n{}, 1 where the light has no "
            "extent)",
            default_soft_rays),
        [&](const std::string& text) { options.rays = parse_int("--rays", text, 1, MAX_SHADOW_RAYS); });
    verb.add_flag(
        "--cones", options.cones,
        "those rays are cones: each sees its share of the light\nthrough coarser voxels the further it goes");
}

void add_map_options(CLI::App& verb, ShadowOptions& options) {
    const auto add = [&](const char* name, const char* value, const char* description, auto parse) {
        add_parsed_option(verb, name, value, description, [&options, parse](const std::string& text) {
            parse(options.map, text);
            options.map_given = true;
        });
    };
    add("--map-size", "N", "texels a side of a soft shadow map; its occluder map has\nhalf (default: 256)",
        [](renderer::SoftShadowOptions& map, const std::string& text) {
            map.receiver_size = parse_int("--map-size", text, 2, max_map_size);
            map.occluder_size = map.receiver_size / 2;
        });
    add("--passes", "one|two",
        "faces of the occluders that it knows: the closest to the\nlight, or the "
        "furthest too (default: two)",
        [](renderer::SoftShadowOptions& map, const std::string& text) {
            map.passes = named("--passes", text,
                               Names<renderer::ShadowPasses>{{"one", renderer::ShadowPasses::one},
                                                             {"two", renderer::ShadowPasses::two}});
        });
    add("--format", "fp16|fp16-batches|fp32", "what it is summed in (default: fp32)",
        [](renderer::SoftShadowOptions& map, const std::string& text) {
            using renderer::ShadowFormat;
            map.format = named("--format", text,
                               Names<ShadowFormat>{{"fp16", ShadowFormat::fp16},
                                                   {"fp16-batches", ShadowFormat::fp16_batches},
                                                   {"fp32", ShadowFormat::fp32}});
        });
}

[[noreturn]] void refuse(const char* option, const char* what, const char* way_out) {
    throw Error(Fault::usage, option, what, way_out);
}

void check(const ShadowOptions& options) {
    if (!options.method)
        refuse("--method", "it is missing", "choose voxel, pyramid, soft-shadow-map or embree");
    const bool is_map = *options.method == ShadowMethod::soft_shadow_map;
    if (options.direction && options.view.light)
        refuse("--light-direction", "there is a --light already", "give one of them");
    const bool has_axes = options.rectangle || options.disk;
    if (options.rectangle && options.disk)
        refuse("--light-disk", "the light is a rectangle", "give one of them");
    if (has_axes && !options.view.light)
        refuse(options.disk ? "--light-disk" : "--light-size", "the light has no place",
               "give it with --light");
    if (has_axes && options.view.view.light.radius > 0.0)
        refuse("--light", "a sphere is no rectangle and no disk", "leave out its fourth number");
    if (options.target && !has_axes)
        refuse("--light-target", "only a rectangle or a disk has one", "add --light-size or --light-disk");
    if (options.map_given && !is_map)
        refuse("--method", "--map-size, --passes and --format are of soft-shadow-map", "leave them out");
    if (is_map && !options.rectangle)
        refuse("--method", "soft shadow maps need a rectangle", "add --light and --light-size");
    if (is_map && options.rays) refuse("--rays", "soft shadow maps send none", "leave it out");
    if (options.cones && *options.method != ShadowMethod::voxel)
        refuse("--cones", "only voxels are seen by cones", "leave it out, or choose --method voxel");
    if (is_map && options.occluders.empty() && options.receivers.empty())
        refuse("--method", "soft shadow maps know no self-shadowing", "name --occluders or --receivers");
    if (options.difference && !options.compare)
        refuse("--difference", "nothing is compared", "add --compare embree");
}

optics::Light light_of(const ShadowOptions& options, const optics::Light& given,
                       const scenes::Bounds& bounds) {
    if (options.direction) return *options.direction;
    optics::Light light = given;
    if (!options.rectangle && !options.disk) return light;
    const glm::dvec3 target = options.target.value_or(0.5 * (bounds.low + bounds.high));
    const glm::dvec2 size = options.rectangle.value_or(glm::dvec2(2.0 * options.disk.value_or(1.0)));
    const renderer::RectangleLight aimed = renderer::aimed_light(light.position, target, size.x, size.y);
    light.shape = options.disk ? optics::LightShape::disk : optics::LightShape::rectangle;
    light.half_u = aimed.half_u;
    light.half_v = aimed.half_v;
    return light;
}

}  // namespace

void add_shadow_options(CLI::App& verb, ShadowOptions& options) {
    add_parsed_option(verb, "--method", "voxel|pyramid|soft-shadow-map|embree", "what computes the shadow",
                      [&](const std::string& text) {
                          options.method =
                              named("--method", text,
                                    Names<ShadowMethod>{{"voxel", ShadowMethod::voxel},
                                                        {"pyramid", ShadowMethod::pyramid},
                                                        {"soft-shadow-map", ShadowMethod::soft_shadow_map},
                                                        {"embree", ShadowMethod::embree}});
                      });
    add_parsed_option(verb, "--compare", "embree", "tells how far the shadow is from that of Embree's rays",
                      [&](const std::string& text) {
                          options.compare = named("--compare", text, Names<bool>{{"embree", true}});
                      });
    add_output_option(verb, options.output, {".png"}, "the picture (default: none)");
    verb.add_option_function<std::string>(
            "--difference", [&](const std::string& text) { options.difference = text; },
            "a picture of the difference: red where the shadow is too\ndark, blue where it is too light")
        ->type_name("OUT.png");
    add_camera_options(verb, options.view);
    add_light_options(verb, options);
    verb.add_option(
            "--occluders", options.occluders,
            "nodes that throw the shadow, and all under them, by name\nor number (default: all others)")
        ->type_name("NODE");
    verb.add_option("--receivers", options.receivers,
                    "nodes that it falls on (default: all others); the only\nones whose pixels are compared")
        ->type_name("NODE");
    add_map_options(verb, options);
    verb.add_flag(
        "--ground", options.ground,
        "adds a square under the scene, as wide as it takes to see\nshadows; it stays while the scene moves");
    add_tree_options(verb, options.view);
    options.max_resolution = verb.get_option("--max-resolution");
    add_parsed_option(verb, "--truth-samples", "N",
                      "samples of the light that each of Embree's pixels takes\nat least (default: 256)",
                      [&](const std::string& text) {
                          options.truth_samples = parse_int("--truth-samples", text, 64, max_truth_samples);
                      });
    verb.add_option_function<std::string>(
            "--truth-cache", [&](const std::string& text) { options.truth_cache = text; },
            "keeps what Embree found of a soft light in this folder,\nand takes it from there when nothing "
            "has "
            "changed")
        ->type_name("DIR");
    add_common_options(verb, options.common);
}

int pyramid_resolution(const ShadowOptions& options) {
    constexpr int usual = 512;
    return options.max_resolution->count() > 0 ? options.view.tree.max_resolution : usual;
}

ShadowTask make_shadow_task(const ShadowOptions& options) {
    check(options);
    ShadowTask task{load_input(options.common.scene, options.common.report.quiet), {}, {}, {}, {}};
    if (options.ground) add_ground(task.input);
    const std::size_t nodes = task.input.scene.nodes.size();
    if (options.occluders.empty() && options.receivers.empty()) {
        task.occluders = task.receivers = scenes::NodeSelection(nodes, true);
    } else if (options.receivers.empty()) {
        task.occluders = scenes::select_nodes(task.input.scene, options.occluders);
        task.receivers = scenes::other_nodes(task.occluders);
    } else {
        task.receivers = scenes::select_nodes(task.input.scene, options.receivers);
        task.occluders = options.occluders.empty()
                             ? scenes::other_nodes(task.receivers)
                             : scenes::select_nodes(task.input.scene, options.occluders);
    }
    scenes::NodeSelection both = task.occluders;
    for (std::size_t i = 0; i < nodes; ++i)
        both[i] = both[i] || task.receivers[i];
    task.shown = scenes::part_of(task.input.snapshot, both);
    task.view = view_of(options.view, task.input.snapshot);
    task.view.light = light_of(options, task.view.light, task.shown.bounds);
    const bool extended = optics::has_extent(task.view.light);
    task.view.shadow_rays = options.rays.value_or(extended ? default_soft_rays : 1);
    task.view.shadow_cones = options.cones;
    task.is_soft = extended && (task.view.shadow_rays > 1 || options.cones);
    return task;
}

}  // namespace cairn::app
