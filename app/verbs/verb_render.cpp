#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/options/view_options.h"
#include "app/subject/fractal.h"
#include "app/subject/subject.h"
#include "app/terminal/driver.h"
#include "app/terminal/measure.h"
#include "app/terminal/png.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/verbs/verbs.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/renderer.h"

namespace cairn::app {
namespace {

constexpr int measured_frames = 5;
constexpr double measuring_ms = 2000.0;
constexpr const char* default_output = "cairn.png";

struct Options {
    CommonOptions common;
    std::optional<std::filesystem::path> output;
    ViewOptions view;
    std::optional<std::string> mesh;   ///< a scene that is drawn as triangles
    std::optional<std::string> proxy;  ///< a scene whose faces bound the rays
    bool mesh_shadows = false;
};

void add_options(CLI::App& verb, Options& options) {
    add_output_option(verb, options.output, {".png"},
                      fmt::format("the picture (default: {} in the current folder)", default_output));
    add_table(verb, view_table(), options.view);
    verb.add_option("--mesh", options.mesh,
                    "another scene, or the same, to draw as triangles in the\nsame picture, without voxels")
        ->type_name("SCENE");
    verb.add_flag("--mesh-shadows", options.mesh_shadows, "let the voxels cast shadows on those triangles")
        ->needs("--mesh");
    verb.add_option("--proxy", options.proxy,
                    "a closed mesh: only what lies inside it is shown of the\nvoxels")
        ->type_name("SCENE");
    add_table(verb, zoom_table(), options.view);
    add_common_options(verb, options.common);
}

/// The median of a few frames that find the bricks of the frame before.
double converged_frame_ms(renderer::Renderer& renderer, const renderer::View& view, bool quiet) {
    const Progress progress("measuring", quiet);
    std::vector<double> frames;
    double total = 0.0;
    while (frames.size() < measured_frames && total < measuring_ms) {
        renderer.forget_picture();
        (void)renderer.render(view);
        frames.push_back(renderer.statistics().milliseconds);
        total += frames.back();
    }
    const auto middle = frames.begin() + std::ptrdiff_t(frames.size() / 2);
    std::nth_element(frames.begin(), middle, frames.end());
    return *middle;
}

/// Another scene as triangles: in its rest pose, unless it is the one that is voxelized.
std::shared_ptr<renderer::MeshRaster> load_mesh(const std::string& scene, const Options& options) {
    SceneOptions input = options.common.scene;
    if (scene != input.scene) {
        input = SceneOptions{};
        input.scene = scene;
        input.trust_paths = options.common.scene.trust_paths;
    }
    const SceneInput loaded = load_input(input, options.common.report.quiet);
    return std::make_shared<renderer::MeshRaster>(loaded.scene, loaded.snapshot,
                                                  options.common.driver.shaders);
}

renderer::Mix load_mix(const Options& options, Report& report) {
    renderer::Mix mix;
    if (options.mesh) {
        mix.meshes = load_mesh(*options.mesh, options);
        mix.mesh_shadows = options.mesh_shadows;
        mix.meshes_are_voxelized = *options.mesh == options.common.scene.scene;
        report.add("mesh_triangles", mix.meshes->triangle_count());
    }
    if (options.proxy) mix.proxy = load_mesh(*options.proxy, options);
    return mix;
}

ExitCode run(const Options& options) {
    const bool quiet = options.common.report.quiet;
    const std::filesystem::path output = options.output.value_or(default_output);
    check_writable(output);
    Report report(options.common.report);
    report.add("scene", options.common.scene.scene);
    Stopwatch watch;
    auto subject = std::make_unique<Subject>(options.common.scene, options.view, quiet);
    report.add("load_ms", watch.lap_ms());
    subject->add_figures(report);
    const renderer::View view = subject->view(options.view);

    const Driver driver(options.common.driver);
    report.add("context_ms", watch.lap_ms());
    renderer::Renderer renderer = subject->make_renderer(options.view, options.common.driver.shaders);
    renderer.set_mix(load_mix(options, report));
    subject.reset();  // the renderer has its own copy of what it needs: do not pay twice
    report.add("setup_ms", watch.lap_ms());

    optics::Image image;
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
    report.add("rays_launched", first.rays_launched);
    report.add("tile_queries", first.tile_queries);
    report.add("bricks_produced", first.bricks_produced);
    report.add("bricks_evicted", first.bricks_evicted);
    report.add("bricks_relinked", first.bricks_relinked);
    report.add("bricks_cached", first.bricks_cached);
    report.add("bricks_restored", first.bricks_restored);
    report.add("bricks_resident", renderer.statistics().bricks_resident);
    report.add("node_pool_bytes", first.node_pool_bytes);
    report.add("brick_pool_bytes", first.brick_pool_bytes);
    report.add("brick_cache_bytes", first.brick_cache_bytes);
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
