#include "app/options/view_options.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "app/options/parse.h"
#include "app/options/voxel_rows.h"
#include "base/error.h"
#include "renderer/pool/tree_shape.h"
#include "shaders/interop/pool.h"

namespace cairn::app {
namespace {

constexpr int max_cache_mib = 1 << 20;
constexpr int max_copies = 4096;
/// The finest voxels are 2^-60 of the fractal. At this zoom they are still finer than a pixel.
constexpr int most_zoom = 46;
/// Outside this range, every ray asks for the finest or the coarsest level of the tree.
constexpr double least_pixel_error = 1e-3;
constexpr double largest_pixel_error = 1e3;

optics::Camera camera_of(const char* option, const std::string& text) {
    const std::vector<double> n = parse_numbers(option, text, 6, 7);
    optics::Camera camera{.eye = {n[0], n[1], n[2]}, .target = {n[3], n[4], n[5]}};
    const glm::dvec3 forward = camera.target - camera.eye;
    if (!(glm::dot(forward, forward) > 0.0)) {
        throw Error(Fault::usage, option, "the eye and the target are the same point");
    }
    if (!std::isfinite(glm::dot(forward, forward))) {
        throw Error(Fault::usage, option, "the eye and the target are too far apart");
    }
    // +Y cannot be the up direction of a camera that looks straight up or down.
    if (glm::length(glm::cross(glm::normalize(forward), camera.up)) < 1e-6) camera.up = {0.0, 0.0, -1.0};
    if (n.size() == 7) {
        if (n[6] <= 0.0 || n[6] >= 180.0) {
            throw Error(Fault::usage, option,
                        fmt::format("a field of view of {} degrees is not in (0, 180)", n[6]));
        }
        camera.yfov = glm::radians(n[6]);
    }
    return camera;
}

optics::Light light_of(const char* option, const std::string& text) {
    const std::vector<double> n = parse_numbers(option, text, 3, 4);
    const double radius = n.size() == 4 ? n[3] : 0.0;
    if (radius < 0.0) throw Error(Fault::usage, option, fmt::format("a radius of {} is negative", radius));
    return {.positional = true, .position = {n[0], n[1], n[2]}, .radius = radius};
}

std::string light_text(const optics::Light& light) {
    const glm::dvec3& at = light.position;
    std::string text = fmt::format("{},{},{}", at.x, at.y, at.z);
    if (light.radius > 0.0) text += fmt::format(",{}", light.radius);
    return text;
}

/// The values of `--shadow`.
enum class ShadowKind : std::uint8_t { none, hard, soft };

Names<ShadowKind> shadow_names() {
    return {{"none", ShadowKind::none}, {"hard", ShadowKind::hard}, {"soft", ShadowKind::soft}};
}

renderer::ShadowQuality::Kind quality_of(ShadowKind kind) {
    using Kind = renderer::ShadowQuality::Kind;
    if (kind == ShadowKind::none) return Kind::none;
    return kind == ShadowKind::soft ? Kind::rays : Kind::hard;
}

/// The value of `--shadow` for a shadow, which may be computed by cones.
ShadowKind shadow_kind(const renderer::ShadowQuality& shadow) {
    using Kind = renderer::ShadowQuality::Kind;
    if (shadow.kind == Kind::none) return ShadowKind::none;
    return shadow.kind == Kind::hard || shadow.samples == 1 ? ShadowKind::hard : ShadowKind::soft;
}

Names<renderer::Show> show_names() {
    using renderer::Show;
    return {{"surface", Show::surface}, {"levels", Show::levels}, {"bricks", Show::bricks}};
}

Names<renderer::LevelOfDetail::Kind> level_of_detail_names() {
    using Kind = renderer::LevelOfDetail::Kind;
    return {{"nearest", Kind::nearest}, {"blended", Kind::blended}};
}

/// A row of a cache's memory: in MiB on the command line, in bytes in the options.
template <typename Member>
OptionRow<ViewOptions> mebibytes_row(const char* name, std::string description, int least, Member member) {
    return {name, "MIB", std::move(description),
            [=](ViewOptions& options, const char* option, const std::string& text) {
                member(options) = std::size_t(parse_int(option, text, least, max_cache_mib)) << 20U;
            },
            [=](const ViewOptions& options) { return std::to_string(member(options) >> 20U); }};
}

/// The first light that the renderer can do. Only its colour is taken: glTF's intensities are in candela and
/// lux, which say nothing of how bright a picture should be.
std::optional<optics::Light> first_light(const scenes::Snapshot& snapshot) {
    for (const scenes::PlacedLight& placed : snapshot.lights) {
        const glm::vec3& color = placed.light.color;
        const float strongest = std::max({color.r, color.g, color.b});
        if (placed.light.type == scenes::Light::Type::spot || !(strongest > 0.0F)) continue;
        optics::Light light;
        light.color = color / strongest;
        light.positional = placed.light.type == scenes::Light::Type::point;
        light.position = glm::dvec3(placed.world_from_light[3]);
        const glm::dvec3 towards(placed.world_from_light[2]);  // it shines along -Z
        if (!light.positional) {
            if (!(glm::dot(towards, towards) > 0.0)) continue;
            light.towards = glm::normalize(towards);
        }
        return light;
    }
    return std::nullopt;
}

}  // namespace

OptionTable<ViewOptions> camera_table() {
    return {
        {"--size", "WxH", "pixels (default: {default})",
         [](ViewOptions& options, const char* option, const std::string& text) {
             std::tie(options.view.size.width, options.view.size.height) = parse_size(option, text);
         },
         [](const ViewOptions& options) {
             return fmt::format("{}x{}", options.view.size.width, options.view.size.height);
         }},
        {"--camera", "EX,EY,EZ,TX,TY,TZ[,FOV]",
         "the eye, the point it looks at, and the vertical field of\nview in degrees (default: the whole "
         "scene, 45 degrees)",
         [](ViewOptions& options, const char* option, const std::string& text) {
             options.view.camera = camera_of(option, text);
             options.camera_given = true;
         },
         [](const ViewOptions& options) -> std::optional<std::string> {
             if (!options.camera_given) return std::nullopt;
             return camera_text(options.view.camera);
         }},
        {"--light", "X,Y,Z[,RADIUS]",
         "a white light in the world, a point or a sphere (default:\nthe scene's first directional "
         "or point light; from above\nif it has none)",
         [](ViewOptions& options, const char* option, const std::string& text) {
             options.view.light = light_of(option, text);
             options.light_given = true;
         },
         [](const ViewOptions& options) -> std::optional<std::string> {
             if (!options.light_given) return std::nullopt;
             return light_text(options.view.light);
         }},
    };
}

OptionTable<ViewOptions> shadow_table() {
    const Names<ShadowKind> names = shadow_names();
    return {
        {"--shadow", joined(names, "|", "|"),
         fmt::format("shadows of that light; soft ones take {} rays per\npixel (default: {{default}})",
                     default_soft_rays),
         [names](ViewOptions& options, const char* option, const std::string& text) {
             options.view.shadow.kind = quality_of(named(option, text, names));
         },
         [names](const ViewOptions& options) { return name_of(shadow_kind(options.view.shadow), names); }},
        flag_row<ViewOptions>(
            "--cones",
            "use cones instead of rays for soft shadows; they read\ncoarser voxels the further "
            "they go",
            [](auto& options) -> auto& { return options.cones; }),
    };
}

OptionTable<ViewOptions> tree_table() {
    return {
        max_resolution_row<ViewOptions>([](auto& options) -> auto& { return options.max_resolution; }),
        mebibytes_row(
            "--brick-pool", "memory for bricks, in MiB (default: {default})", 1,
            [](auto& options) -> auto& { return options.pools.brick_bytes; }),
        mebibytes_row(
            "--brick-cache",
            "main memory for bricks that had to leave the brick pool,\nin MiB (default: 0, none)", 0,
            [](auto& options) -> auto& { return options.pools.cache_bytes; }),
        number_row<ViewOptions>(
            "--pixel-error", "E",
            "the size of voxels on the screen that rays ask for, in\npixels (default: {default})",
            least_pixel_error, largest_pixel_error,
            [](auto& options) -> auto& { return options.view.detail.pixel_error; }),
    };
}

OptionTable<ViewOptions> march_table() {
    return {
        tree_n_row<ViewOptions>([](auto& options) -> auto& { return options.tree_n; }),
        brick_m_row<ViewOptions>([](auto& options) -> auto& { return options.brick_m; }),
        traversal_row<ViewOptions>([](auto& options) -> auto& { return options.march.traversal; }),
    };
}

OptionTable<ViewOptions> frame_table() {
    return {
        tile_queries_row<ViewOptions>([](auto& options) -> auto& { return options.march.tile_queries; }),
        budget_row<ViewOptions>([](auto& options) -> auto& { return options.frame_budget_ms; }),
    };
}

OptionTable<ViewOptions> look_table() {
    return {
        named_row<ViewOptions>(
            "--level-of-detail",
            "levels of surfaces: the nearest one per pixel, or a blend\nof two, so that nothing pops when "
            "the camera moves\n(default: {default})",
            level_of_detail_names(), [](auto& options) -> auto& { return options.view.detail.kind; }),
        {"--transfer", "NAME|POINTS",
         fmt::format(
             "what the densities of a volume look like:\n{}; or points\nDENSITY:R,G,B:EXTINCTION with \";\" "
             "between them, all in\n[0, 1] but the extinction, which is per voxel\n(default: {})",
             transfer_names(), default_transfer),
         [](ViewOptions& options, const char*, const std::string& text) {
             options.transfer = parse_transfer(text);
         },
         [](const ViewOptions& options) -> std::optional<std::string> {
             if (!options.transfer) return std::nullopt;
             return options.transfer->text;
         }},
        whole_row<ViewOptions>(
            "--copies", "K", "copies of a volume per axis, side by side (default:\n{default})", 1, max_copies,
            [](auto& options) -> auto& { return options.copies; }),
        whole_row<ViewOptions>(
            "--samples", "N",
            fmt::format(
                "rays per pixel, 1 to {}, whose mean the pixel shows: smooth\nedges (default: {{default}})",
                renderer::MAX_SAMPLES),
            1, renderer::MAX_SAMPLES, [](auto& options) -> auto& { return options.view.samples; }),
        steps_row<ViewOptions>([](auto& options) -> auto& { return options.steps_per_voxel; }),
        gradient_row<ViewOptions>([](auto& options) -> auto& { return options.gradient_threshold; }),
        named_row<ViewOptions>(
            "--show",
            "the scene, the level of each voxel in the tree, or the\nlines "
            "between bricks (default: {default})",
            show_names(), [](auto& options) -> auto& { return options.view.show; }),
    };
}

OptionTable<ViewOptions> zoom_table() {
    return {whole_row<ViewOptions>(
        "--zoom", "K",
        fmt::format("for builtin:fractal alone, a set without a finest detail:\nlook 2^K times closer, "
                    "0 to {} (default: {{default}})",
                    most_zoom),
        0, most_zoom, [](auto& options) -> auto& { return options.zoom; })};
}

OptionTable<ViewOptions> view_table() {
    OptionTable<ViewOptions> table;
    for (const auto& part : {camera_table(), shadow_table(), tree_table(), march_table(), look_table()})
        table.insert(table.end(), part.begin(), part.end());
    return table;
}

renderer::ShadowQuality shadow_of(const ViewOptions& options) {
    using Kind = renderer::ShadowQuality::Kind;
    renderer::ShadowQuality shadow = options.view.shadow;
    if (!options.cones || shadow.kind == Kind::none) return shadow;
    // A single cone sees the whole light; a single ray goes to its middle.
    if (shadow.kind == Kind::hard) shadow.samples = 1;
    shadow.kind = Kind::cones;
    return shadow;
}

renderer::View view_of(const ViewOptions& options, const scenes::Snapshot& snapshot) {
    renderer::View view = options.view;
    view.shadow = shadow_of(options);
    if (!options.camera_given) view.camera = optics::framing_camera(snapshot.bounds, view.size.aspect());
    if (!options.light_given) view.light = first_light(snapshot).value_or(view.light);
    return view;
}

std::string camera_text(const optics::Camera& camera) {
    const auto& [eye, target, up, yfov] = camera;
    return fmt::format("{},{},{},{},{},{},{}", eye.x, eye.y, eye.z, target.x, target.y, target.z,
                       degrees_of(yfov));
}

optics::Camera snapped(const optics::Camera& camera) {
    return camera_of("--camera", camera_text(camera));
}

std::string render_command(const SceneOptions& scene, const ViewOptions& options, const renderer::View& view,
                           const std::filesystem::path& output) {
    ViewOptions shown = options;
    shown.view = view;
    shown.cones = view.shadow.kind == renderer::ShadowQuality::Kind::cones;
    shown.camera_given = true;
    std::string line = "cairn render " + shell_word(scene.scene);
    line += command_line(load_table(), scene) + command_line(moment_table(), scene);
    line += command_line(view_table(), shown) + command_line(frame_table(), shown) +
            command_line(zoom_table(), shown);
    return line + " --output=" + shell_word(output.string());
}

}  // namespace cairn::app
