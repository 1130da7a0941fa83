#include "app/options/shadow_options.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "app/options/parse.h"
#include "base/error.h"
#include "shaders/interop/shadow_rays.h"

namespace cairn::app {
namespace {

constexpr int max_truth_samples = 65536;

double positive(const char* option, double value) {
    if (value > 0.0) return value;
    throw Error(Fault::usage, option, fmt::format("{} is not positive", value));
}

optics::Light direction_of(const char* option, const std::string& text) {
    const std::vector<double> n = parse_numbers(option, text, 3, 4);
    optics::Light light{.towards = {n[0], n[1], n[2]}};
    if (!(glm::length(light.towards) > 0.0)) throw Error(Fault::usage, option, "it is no direction");
    const double degrees = n.size() == 4 ? n[3] : 0.0;
    if (!(degrees >= 0.0 && degrees < 89.9))
        throw Error(Fault::usage, option, fmt::format("an angle of {} degrees", degrees),
                    "choose 0 to 89, from the light's middle to its edge");
    light.angle = glm::radians(degrees);
    return light;
}

std::string direction_text(const optics::Light& light) {
    const glm::dvec3& towards = light.towards;
    std::string text = fmt::format("{},{},{}", towards.x, towards.y, towards.z);
    if (light.angle > 0.0) text += fmt::format(",{}", degrees_of(light.angle));
    return text;
}

template <typename Value>
std::optional<std::string> text_of(const std::optional<Value>& value) {
    if (!value) return std::nullopt;
    return fmt::format("{}", *value);
}

/// A row of an option of soft shadow maps: parsing it sets `map_given`.
OptionRow<ShadowOptions> map_row(OptionRow<ShadowOptions> row) {
    row.parse = [parse = row.parse](ShadowOptions& options, const char* option, const std::string& text) {
        parse(options, option, text);
        options.map_given = true;
    };
    return row;
}

OptionTable<ShadowOptions> method_table() {
    return {
        named_row<ShadowOptions>(
            "--method", "the method that computes the shadow", shadow_method_names(),
            [](auto& options) -> auto& { return options.method; }),
        {"--compare", "embree", "report the difference from the shadow by Embree's rays",
         [](ShadowOptions& options, const char* option, const std::string& text) {
             options.compare = named(option, text, Names<bool>{{"embree", true}});
         },
         [](const ShadowOptions& options) {
             return options.compare ? std::optional<std::string>("embree") : std::nullopt;
         }},
    };
}

OptionTable<ShadowOptions> light_table() {
    return {
        {"--light-direction", "X,Y,Z[,ANGLE]",
         "a light infinitely far away in this direction, and the\ndegrees from its middle to its edge",
         [](ShadowOptions& options, const char* option, const std::string& text) {
             options.direction = direction_of(option, text);
         },
         [](const ShadowOptions& options) {
             return options.direction ? std::optional(direction_text(*options.direction)) : std::nullopt;
         }},
        {"--light-size", "W,H", "make --light a rectangle",
         [](ShadowOptions& options, const char* option, const std::string& text) {
             const std::vector<double> n = parse_numbers(option, text, 2, 2);
             options.rectangle = {positive(option, n[0]), positive(option, n[1])};
         },
         [](const ShadowOptions& options) -> std::optional<std::string> {
             if (!options.rectangle) return std::nullopt;
             return fmt::format("{},{}", options.rectangle->x, options.rectangle->y);
         }},
        {"--light-disk", "RADIUS", "make --light a disk",
         [](ShadowOptions& options, const char* option, const std::string& text) {
             options.disk = positive(option, parse_number(option, text));
         },
         [](const ShadowOptions& options) { return text_of(options.disk); }},
        {"--light-target", "X,Y,Z",
         "the point that a rectangle or a disk faces (default: the\nscene's middle)",
         [](ShadowOptions& options, const char* option, const std::string& text) {
             const std::vector<double> n = parse_numbers(option, text, 3, 3);
             options.target = {n[0], n[1], n[2]};
         },
         [](const ShadowOptions& options) -> std::optional<std::string> {
             if (!options.target) return std::nullopt;
             const glm::dvec3& at = *options.target;
             return fmt::format("{},{},{}", at.x, at.y, at.z);
         }},
        whole_row<ShadowOptions>(
            "--rays", "N",
            fmt::format(
                "rays per pixel to the light; a single ray goes to its\nmiddle (default: {}; 1 if the light "
                "has no extent)",
                default_soft_rays),
            1, MAX_SHADOW_RAYS, [](auto& options) -> auto& { return options.rays; }),
        flag_row<ShadowOptions>(
            "--cones",
            "use cones instead of rays: each sees its share of the\nlight through coarser voxels the further "
            "it "
            "goes",
            [](auto& options) -> auto& { return options.cones; }),
    };
}

OptionTable<ShadowOptions> map_table() {
    using renderer::ShadowFormat;
    using renderer::ShadowPasses;
    return {
        map_row({"--map-size", "N",
                 "texels per side of a soft shadow map; its occluder map\nhas half (default: {default})",
                 [](ShadowOptions& options, const char* option, const std::string& text) {
                     options.map.receiver_size = parse_int(option, text, 2, renderer::max_shadow_map_size);
                     options.map.occluder_size = options.map.receiver_size / 2;
                 },
                 [](const ShadowOptions& options) { return std::to_string(options.map.receiver_size); }}),
        map_row(named_row<ShadowOptions>(
            "--passes",
            "the occluders' faces that a soft shadow map holds: the\nclosest to the light, or the furthest "
            "too (default:\n{default})",
            Names<ShadowPasses>{{"one", ShadowPasses::one}, {"two", ShadowPasses::two}},
            [](auto& options) -> auto& { return options.map.passes; })),
        map_row(named_row<ShadowOptions>(
            "--format", "the format of a soft shadow map's sums (default: {default})",
            Names<ShadowFormat>{{"fp16", ShadowFormat::fp16},
                                {"fp16-batches", ShadowFormat::fp16_batches},
                                {"fp32", ShadowFormat::fp32}},
            [](auto& options) -> auto& { return options.map.format; })),
        flag_row<ShadowOptions>(
            "--ground",
            "add a square under the scene, wide enough for its\nshadows; it stays while the scene moves",
            [](auto& options) -> auto& { return options.ground; }),
    };
}

}  // namespace

OptionTable<ShadowOptions> truth_table() {
    return {
        whole_row<ShadowOptions>(
            "--truth-samples", "N",
            "the least number of samples of the light per pixel of\nEmbree's picture "
            "(default: {default})",
            64, max_truth_samples, [](auto& options) -> auto& { return options.truth_samples; }),
        text_row<ShadowOptions>(
            "--truth-cache", "DIR",
            "a folder that keeps Embree's shares of a soft light, for\nthe next run "
            "with the same scene, view and light",
            [](auto& options) -> auto& { return options.truth_cache; }),
    };
}

Names<ShadowMethod> shadow_method_names() {
    return {{"voxel", ShadowMethod::voxel},
            {"pyramid", ShadowMethod::pyramid},
            {"soft-shadow-map", ShadowMethod::soft_shadow_map},
            {"embree", ShadowMethod::embree}};
}

OptionTable<ShadowOptions> shadow_option_table() {
    OptionTable<ShadowOptions> table;
    for (const auto& part : {method_table(), light_table(), map_table(), truth_table()})
        table.insert(table.end(), part.begin(), part.end());
    return table;
}

void add_shadow_options(CLI::App& verb, ShadowOptions& options) {
    add_table(verb, method_table(), options);
    add_output_option(verb, options.output, {".png"}, "the picture (default: none)");
    verb.add_option_function<std::string>(
            "--difference", [&](const std::string& text) { options.difference = text; },
            "a picture of the difference: red where the shadow is too\ndark, blue where it is too light")
        ->type_name(output_file);
    add_table(verb, camera_table(), options.view);
    add_table(verb, light_table(), options);
    verb.add_option(
            "--occluders", options.occluders,
            "nodes that cast the shadow, with all below them, by name\nor number (default: all others)")
        ->type_name("NODE");
    verb.add_option("--receivers", options.receivers,
                    "nodes that the shadow falls on (default: all others);\nonly their pixels are compared")
        ->type_name("NODE");
    add_table(verb, map_table(), options);
    add_table(verb, tree_table(), options.view);
    add_table(verb, truth_table(), options);
    add_common_options(verb, options.common);
}

}  // namespace cairn::app
