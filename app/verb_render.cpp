#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "app/driver.h"
#include "app/measure.h"
#include "app/parse.h"
#include "app/png.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/scene_input.h"
#include "app/verbs.h"
#include "base/error.h"
#include "renderer/renderer.h"
#include "shaders/interop/config.h"

namespace cairn::app {
namespace {

constexpr int max_tree_resolution = 1 << MAX_RESOLUTION_BITS;
constexpr int max_brick_pool_mib = 1 << 20;
constexpr int measured_frames = 5;
constexpr double measuring_ms = 2000.0;
constexpr const char* default_output = "cairn.png";

struct Options {
    CommonOptions common;
    std::optional<std::filesystem::path> output;
    renderer::View view;
    renderer::TreeOptions tree;
    bool camera_given = false;
    bool light_given = false;
};

renderer::Camera camera_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--camera", text, 6, 7);
    renderer::Camera camera{.eye = {n[0], n[1], n[2]}, .target = {n[3], n[4], n[5]}};
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

renderer::Light light_of(const std::string& text) {
    const std::vector<double> n = parse_numbers("--light", text, 3, 4);
    if (n.size() == 4) {
        throw Error(Fault::usage, "--light", "a radius needs soft shadows, which do not exist yet",
                    "leave the fourth number out: the light is a point");
    }
    return {.positional = true, .position = {n[0], n[1], n[2]}};
}

renderer::Shadow shadow_named(const std::string& name) {
    if (name == "none") return renderer::Shadow::none;
    if (name == "hard") return renderer::Shadow::hard;
    throw Error(Fault::usage, "--shadow", fmt::format("there is no \"{}\"", name), "choose none or hard");
}

void add_options(CLI::App& verb, Options& options) {
    add_output_option(verb, options.output, {".png"},
                      fmt::format("the picture (default: {} in the current folder)", default_output));
    add_parsed_option(verb, "--size", "WxH", "pixels (default: 512x512)",
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
    add_parsed_option(verb, "--light", "X,Y,Z",
                      "a white point light in the world (default: the scene's\nfirst directional or point "
                      "light; from above "
                      "if it has none)",
                      [&options](const std::string& text) {
                          options.view.light = light_of(text);
                          options.light_given = true;
                      });
    add_parsed_option(verb, "--shadow", "none|hard", "shadows of that light (default: hard)",
                      [&options](const std::string& text) { options.view.shadow = shadow_named(text); });
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
        });
    add_common_options(verb, options.common);
}

/// The first light that the renderer can do. Only its colour is taken: glTF's intensities are in candela and
/// lux, which say nothing of how bright a picture should be.
std::optional<renderer::Light> first_light(const scenes::Snapshot& snapshot) {
    for (const scenes::PlacedLight& placed : snapshot.lights) {
        const glm::vec3& color = placed.light.color;
        const float strongest = std::max({color.r, color.g, color.b});
        if (placed.light.type == scenes::Light::Type::spot || !(strongest > 0.0F)) continue;
        renderer::Light light;
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

renderer::View view_of(const Options& options, const scenes::Snapshot& snapshot) {
    renderer::View view = options.view;
    if (!options.camera_given) {
        view.camera = renderer::framing_camera(snapshot.bounds, double(view.width) / double(view.height));
    }
    if (!options.light_given) view.light = first_light(snapshot).value_or(view.light);
    return view;
}

/// The median of a few frames that find the bricks of the frame before.
double converged_frame_ms(renderer::Renderer& renderer, const renderer::View& view, bool quiet) {
    const Progress progress("measuring", quiet);
    std::vector<double> frames;
    double total = 0.0;
    while (frames.size() < measured_frames && total < measuring_ms) {
        (void)renderer.render(view);
        frames.push_back(renderer.statistics().milliseconds);
        total += frames.back();
    }
    const auto middle = frames.begin() + std::ptrdiff_t(frames.size() / 2);
    std::nth_element(frames.begin(), middle, frames.end());
    return *middle;
}

ExitCode run(const Options& options) {
    const bool quiet = options.common.report.quiet;
    const std::filesystem::path output = options.output.value_or(default_output);
    check_writable(output);
    Report report(options.common.report);
    report.add("scene", options.common.scene.scene);
    Stopwatch watch;
    auto input = std::make_unique<SceneInput>(load_input(options.common.scene, quiet));
    report.add("load_ms", watch.lap_ms());
    report.add("triangles", input->snapshot.triangle_count);
    const renderer::View view = view_of(options, input->snapshot);

    const Driver driver(options.common.driver);
    report.add("context_ms", watch.lap_ms());
    renderer::Renderer renderer(input->scene, input->snapshot, options.tree, options.common.driver.shaders);
    input.reset();  // the renderer has its own copy of what it needs: do not pay twice
    report.add("setup_ms", watch.lap_ms());

    renderer::Image image;
    {
        Progress progress("rendering", quiet);
        image = renderer.render(view, [&progress](double share) { progress.set(share); });
    }
    const renderer::FrameStatistics first = renderer.statistics();
    report.add("first_frame_ms", first.milliseconds);
    (void)watch.lap_ms();
    write_png(image, output);
    const double write_ms = watch.lap_ms();
    // Frames that nobody asked about are not worth their time.
    if (!quiet || options.common.report.json) {
        report.add("frame_ms", converged_frame_ms(renderer, view, quiet));
    }
    driver.check();

    report.add("write_ms", write_ms);
    report.add("width", view.width);
    report.add("height", view.height);
    report.add("passes", first.passes);
    report.add("tile_queries", first.tile_queries);
    report.add("bricks_produced", first.bricks_produced);
    report.add("bricks_evicted", first.bricks_evicted);
    report.add("bricks_resident", renderer.statistics().bricks_resident);
    report.add("node_pool_bytes", first.node_pool_bytes);
    report.add("brick_pool_bytes", first.brick_pool_bytes);
    report.add("peak_rss_bytes", peak_rss_bytes());
    report.add("driver", driver.name());
    report.add("backend", driver.backend());
    report.add("output", output.string());
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_render(CLI::App& command, Work& chosen) {
    add_verb<Options>(command, chosen, "render", "Make a picture of a scene through its voxel cache",
                      add_options, run);
}

}  // namespace cairn::app
