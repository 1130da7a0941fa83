#include "app/options/view_options.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "app/options/parse.h"
#include "base/error.h"
#include "shaders/interop/pool.h"

namespace cairn::app {
namespace {

constexpr int max_tree_resolution = 1 << MAX_RESOLUTION_BITS;
constexpr int max_brick_pool_mib = 1 << 20;
/// Outside, every ray asks for the finest or the coarsest level there is.
constexpr double least_pixel_error = 1e-3;
constexpr double largest_pixel_error = 1e3;

optics::Camera camera_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--camera", text, 6, 7);
    optics::Camera camera{.eye = {n[0], n[1], n[2]}, .target = {n[3], n[4], n[5]}};
    const glm::dvec3 forward = camera.target - camera.eye;
    if (!(glm::dot(forward, forward) > 0.0)) {
        throw Error(Fault::usage, "--camera", "the eye and the target are the same point");
    }
    if (!std::isfinite(glm::dot(forward, forward))) {
        throw Error(Fault::usage, "--camera", "the eye and the target are too far apart");
    }
    // Looking straight up or down, +Y is no way up.
    if (glm::length(glm::cross(glm::normalize(forward), camera.up)) < 1e-6) camera.up = {0.0, 0.0, -1.0};
    if (n.size() == 7) {
        if (n[6] <= 0.0 || n[6] >= 180.0) {
            throw Error(Fault::usage, "--camera",
                        fmt::format("a field of view of {} degrees is not in (0, 180)", n[6]));
        }
        camera.yfov = glm::radians(n[6]);
    }
    return camera;
}

optics::Light light_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--light", text, 3, 4);
    const double radius = n.size() == 4 ? n[3] : 0.0;
    if (radius < 0.0) throw Error(Fault::usage, "--light", fmt::format("a radius of {} is negative", radius));
    return {.positional = true, .position = {n[0], n[1], n[2]}, .radius = radius};
}

void set_shadow(renderer::View& view, const std::string& name) {
    if (name != "none" && name != "hard" && name != "soft") {
        throw Error(Fault::usage, "--shadow", fmt::format("there is no \"{}\"", name),
                    "choose none, hard or soft");
    }
    view.shadow = name == "none" ? renderer::Shadow::none : renderer::Shadow::hard;
    view.shadow_rays = name == "soft" ? default_soft_rays : 1;
}

constexpr std::string_view show_names[] = {"surface", "levels", "bricks"};

renderer::Show show_named(const std::string& name) {
    for (int i = 0; i < int(std::size(show_names)); ++i) {
        if (name == show_names[i]) return renderer::Show(i);
    }
    throw Error(Fault::usage, "--show", fmt::format("there is no \"{}\"", name),
                "choose surface, levels or bricks");
}

renderer::LevelOfDetail level_of_detail_named(const std::string& name) {
    if (name == "nearest") return renderer::LevelOfDetail::nearest;
    if (name == "blended") return renderer::LevelOfDetail::blended;
    throw Error(Fault::usage, "--level-of-detail", fmt::format("there is no \"{}\"", name),
                "choose nearest or blended");
}

double pixel_error_of(const std::string& text) {
    const double pixels = parse_number("--pixel-error", text);
    if (pixels < least_pixel_error || pixels > largest_pixel_error) {
        throw Error(
            Fault::usage, "--pixel-error",
            fmt::format("{} is not between {} and {}", pixels, least_pixel_error, largest_pixel_error));
    }
    return pixels;
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

/// Rounded, so that the way from degrees to radians and back ends where it began.
double degrees_of(double radians) {
    constexpr double steps_a_degree = 1e9;
    return std::round(glm::degrees(radians) * steps_a_degree) / steps_a_degree;
}

/// For a POSIX shell: bare where nothing in it has a meaning there.
std::string shell_word(const std::string& text) {
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string_view("_-+=./:,@%").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

}  // namespace

void add_camera_options(CLI::App& verb, ViewOptions& options) {
    add_parsed_option(verb, "--size", "WxH",
                      fmt::format("pixels (default: {}x{})", options.view.width, options.view.height),
                      [&options](const std::string& text) {
                          std::tie(options.view.width, options.view.height) = parse_size("--size", text);
                      });
    add_parsed_option(
        verb, "--camera", "EX,EY,EZ,TX,TY,TZ[,FOV]",
        "the eye, the point it looks at, and the vertical field of\nview in degrees (default: the whole "
        "scene, 45 degrees)",
        [&options](const std::string& text) {
            options.view.camera = camera_of(text);
            options.camera_given = true;
        });
    add_parsed_option(
        verb, "--light", "X,Y,Z[,RADIUS]",
        "a white light in the world, a point or a sphere (default:\nthe scene's first directional "
        "or point light; from above\nif it has none)",
        [&options](const std::string& text) {
            options.view.light = light_of(text);
            options.light = text;
        });
}

void add_tree_options(CLI::App& verb, ViewOptions& options) {
    add_parsed_option(verb, "--max-resolution", "N",
                      fmt::format("the most voxels across the scene that rays may ask for\n(default: {})",
                                  options.tree.max_resolution),
                      [&options](const std::string& text) {
                          options.tree.max_resolution =
                              parse_int("--max-resolution", text, options.tree.m, max_tree_resolution);
                      });
    add_parsed_option(
        verb, "--brick-pool", "MIB",
        fmt::format("memory for bricks, in MiB (default: {})", options.tree.brick_pool_bytes >> 20U),
        [&options](const std::string& text) {
            options.tree.brick_pool_bytes =
                std::size_t(parse_int("--brick-pool", text, 1, max_brick_pool_mib)) << 20U;
            options.brick_pool = text;
        });
    add_parsed_option(verb, "--brick-cache", "MIB",
                      "main memory for bricks that had to leave the brick pool,\nin MiB (default: 0, none)",
                      [&options](const std::string& text) {
                          options.tree.brick_cache_bytes =
                              std::size_t(parse_int("--brick-cache", text, 0, max_brick_pool_mib)) << 20U;
                          options.brick_cache = text;
                      });
    add_parsed_option(
        verb, "--pixel-error", "E",
        "the size of a voxel on the screen, in pixels, that rays\nlook for (default: 1)",
        [&options](const std::string& text) { options.view.pixel_error = pixel_error_of(text); });
}

void add_view_options(CLI::App& verb, ViewOptions& options) {
    add_camera_options(verb, options);
    add_parsed_option(verb, "--shadow", "none|hard|soft",
                      fmt::format("shadows of that light; soft ones take {} rays a pixel\n(default: hard)",
                                  default_soft_rays),
                      [&options](const std::string& text) { set_shadow(options.view, text); });
    verb.add_flag("--cones", options.view.shadow_cones,
                  "the rays of soft shadows are cones, which read coarser\nvoxels the further they go");
    add_tree_options(verb, options);
    add_parsed_option(
        verb, "--level-of-detail", "nearest|blended",
        "one size of voxels at a time, or two that lead over, so\nthat nothing pops when the camera moves; "
        "of surfaces\n(default: nearest)",
        [&options](const std::string& text) {
            options.view.level_of_detail = level_of_detail_named(text);
            options.tree.mips = options.view.level_of_detail == renderer::LevelOfDetail::blended;
        });
    add_parsed_option(
        verb, "--transfer", "NAME|POINTS",
        fmt::format(
            "what the densities of a volume look like:\n{}; or points\nDENSITY:R,G,B:EXTINCTION with \";\" "
            "between them, all in\n[0, 1] but the extinction, which is for each voxel\n(default: {})",
            transfer_names(), default_transfer),
        [&options](const std::string& text) { options.transfer = parse_transfer(text); });
    add_parsed_option(
        verb, "--copies", "K", "a volume K times along each axis, side by side (default: 1)",
        [&options](const std::string& text) { options.copies = parse_int("--copies", text, 1, max_copies); });
    add_parsed_option(
        verb, "--show", "surface|levels|bricks",
        "the scene, or what its voxels are: their level in the\ntree, or the lines between bricks "
        "(default: surface)",
        [&options](const std::string& text) { options.view.show = show_named(text); });
}

renderer::View view_of(const ViewOptions& options, const scenes::Snapshot& snapshot) {
    renderer::View view = options.view;
    if (!options.camera_given) {
        const double aspect = double(view.width) / double(view.height);
        view.camera = optics::framing_camera(snapshot.bounds, aspect);
    }
    if (!options.light) view.light = first_light(snapshot).value_or(view.light);
    return view;
}

std::string camera_text(const optics::Camera& camera) {
    const auto& [eye, target, up, yfov] = camera;
    return fmt::format("{},{},{},{},{},{},{}", eye.x, eye.y, eye.z, target.x, target.y, target.z,
                       degrees_of(yfov));
}

optics::Camera snapped(const optics::Camera& camera) {
    return camera_of(camera_text(camera));
}

std::string render_command(const SceneOptions& scene, const ViewOptions& options, const renderer::View& view,
                           const std::filesystem::path& output) {
    std::string line = "cairn render " + shell_word(scene.scene);
    const auto add = [&line](const char* name, const std::string& value) {
        // With "=", a value may begin with a minus.
        line += fmt::format(" {}={}", name, shell_word(value));
    };
    if (scene.seconds) add("--time", fmt::format("{}", *scene.seconds));
    if (scene.animation) add("--animation", *scene.animation);
    if (scene.scene_index) add("--scene-index", std::to_string(*scene.scene_index));
    if (scene.trust_paths) line += " --trust-paths";
    add("--size", fmt::format("{}x{}", view.width, view.height));
    add("--camera", camera_text(view.camera));
    if (options.light) add("--light", *options.light);
    if (view.shadow == renderer::Shadow::none) add("--shadow", "none");
    if (view.shadow == renderer::Shadow::hard && view.shadow_rays > 1) add("--shadow", "soft");
    if (view.shadow_cones) line += " --cones";
    if (view.pixel_error != renderer::View{}.pixel_error)
        add("--pixel-error", fmt::format("{}", view.pixel_error));
    if (view.level_of_detail == renderer::LevelOfDetail::blended) add("--level-of-detail", "blended");
    if (view.show != renderer::Show::surface) add("--show", std::string(show_names[int(view.show)]));
    if (options.tree.max_resolution != renderer::TreeOptions{}.max_resolution)
        add("--max-resolution", std::to_string(options.tree.max_resolution));
    if (options.brick_pool) add("--brick-pool", *options.brick_pool);
    if (options.brick_cache) add("--brick-cache", *options.brick_cache);
    if (options.transfer) add("--transfer", options.transfer->text);
    if (options.copies != 1) add("--copies", std::to_string(options.copies));
    add("--output", output.string());
    return line;
}

}  // namespace cairn::app
