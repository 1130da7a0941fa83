#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/options/view_options.h"
#include "app/options/voxel_rows.h"
#include "app/subject/scene_input.h"
#include "app/subject/subject.h"
#include "app/terminal/driver.h"
#include "app/terminal/measure.h"
#include "app/terminal/png.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/terminal/terminal.h"
#include "app/verbs/verbs.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
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
    std::optional<std::string> mesh;   ///< scene that is drawn as triangles
    std::optional<std::string> proxy;  ///< scene whose faces bound the rays
    bool mesh_shadows = false;
    bool measure = false;
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
                    "a scene that is a closed mesh: only voxels inside it are\nshown")
        ->type_name("SCENE");
    add_table(verb, frame_table(), options.view);
    add_table(verb, zoom_table(), options.view);
    verb.add_flag(
        "--measure", options.measure,
        fmt::format("draw the picture up to {} times more, and report how long\na frame takes whose "
                    "bricks are there",
                    measured_frames));
    add_common_options(verb, options.common);
}

/// Repeated frames of one view, whose bricks are there already.
struct Repeated {
    double median_ms = 0.0;
    renderer::FrameStatistics last;
};

Repeated repeat(renderer::Renderer& renderer, const renderer::View& view, const renderer::Request& request,
                bool quiet) {
    const Progress progress("measuring", quiet);
    Repeated repeated;
    std::vector<double> frames;
    double total = 0.0;
    while (frames.size() < measured_frames && total < measuring_ms) {
        renderer.forget_picture();
        repeated.last = renderer.render(view, request).statistics;
        frames.push_back(repeated.last.milliseconds);
        total += frames.back();
    }
    const auto middle = frames.begin() + std::ptrdiff_t(frames.size() / 2);
    std::nth_element(frames.begin(), middle, frames.end());
    repeated.median_ms = *middle;
    return repeated;
}

/// Adds how the picture was made, as far as the counters do not say it.
void add_settings(const Subject& subject, const ViewOptions& options, Report& report) {
    report.add("tree_n", subject.tree().n);
    report.add("brick_m", subject.tree().m);
    if (const std::optional<std::int64_t> finest = subject.finest_resolution())
        report.add("finest_resolution", *finest);
    report.add("traversal", name_of(options.march.traversal, traversal_names()));
    report.add("tile_query_method", name_of(options.march.tile_queries, tile_query_names()));
    if (options.frame_budget_ms) report.add("frame_budget_ms", *options.frame_budget_ms);
    if (subject.kind() != renderer::ContentKind::volume) return;
    const renderer::VolumeOptions usual;
    report.add("steps_per_voxel", options.steps_per_voxel.value_or(usual.steps_per_voxel));
    report.add("gradient_threshold", options.gradient_threshold.value_or(usual.full_gradient));
}

void add_counters(const renderer::FrameStatistics& first, const renderer::FrameStatistics& last,
                  Report& report) {
    report.add("passes", first.passes);
    report.add("converged", first.converged);
    report.add("rays_launched", first.rays_launched);
    report.add("tile_queries", first.tile_queries);
    report.add("bricks_produced", first.bricks_produced);
    report.add("bricks_evicted", first.bricks_evicted);
    report.add("bricks_relinked", first.bricks_relinked);
    report.add("bricks_cached", first.bricks_cached);
    report.add("bricks_restored", first.bricks_restored);
    report.add("bricks_resident", last.bricks_resident);
    report.add("node_pool_bytes", first.node_pool_bytes);
    report.add("brick_pool_bytes", first.brick_pool_bytes);
    report.add("brick_cache_bytes", first.brick_cache_bytes);
}

/// A scene as triangles: in its rest pose, unless it is the one that is voxelized.
std::shared_ptr<renderer::MeshRaster> load_mesh(const std::string& scene, const Options& options) {
    SceneOptions input = options.common.scene;
    if (scene != input.scene) {
        input = SceneOptions{};
        input.scene = scene;
        input.load = options.common.scene.load;
    }
    const SceneInput loaded = load_input(input, options.common.report.quiet);
    return renderer::make_mesh_raster(loaded.scene, loaded.snapshot, options.common.driver.shaders);
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
    if (options.measure && quiet && !options.common.report.json)
        throw Error(Fault::usage, "--measure", "nothing reports the time",
                    "add --json, or leave --quiet out");
    if (options.view.frame_budget_ms && options.view.view.samples != 1)
        throw Error(Fault::usage, "--samples", "a frame within a budget has one ray per pixel",
                    "leave --frame-budget or --samples out");
    check_writable(output);
    Report report(options.common.report);
    report.add("scene", options.common.scene.scene);
    Stopwatch watch;
    auto subject = std::make_unique<Subject>(options.common.scene, options.view, quiet);
    report.add("load_ms", watch.lap_ms());
    subject->add_figures(report);
    const renderer::View view = subject->view(options.view);
    if (!quiet) {
        for (const std::string& text : subject->unmet(options.view, view))
            warn(text);
    }

    const Driver driver(options.common.driver);
    report.add("context_ms", watch.lap_ms());
    renderer::Renderer renderer(subject->content(options.common.driver.shaders),
                                {options.view.pools, options.view.march}, options.common.driver.shaders);
    renderer.set_mix(load_mix(options, report));
    add_settings(*subject, options.view, report);
    subject.reset();  // the renderer has copies of all that it needs
    report.add("setup_ms", watch.lap_ms());

    renderer::Request request;
    if (options.view.frame_budget_ms) request.budget = Milliseconds(*options.view.frame_budget_ms);
    renderer::Frame first;
    {
        Progress progress("rendering", quiet);
        renderer::Request watched = request;
        watched.progress = [&progress](double share) { progress.set(share); };
        first = renderer.render(view, watched);
    }
    report.add("first_frame_ms", first.statistics.milliseconds);
    (void)watch.lap_ms();
    write_png(first.image, output);
    const double write_ms = watch.lap_ms();
    renderer::FrameStatistics last = first.statistics;
    if (options.measure) {
        const Repeated repeated = repeat(renderer, view, request, quiet);
        report.add("frame_ms", repeated.median_ms);
        last = repeated.last;
    }
    driver.check();

    report.add("write_ms", write_ms);
    report.add("samples", view.samples);
    report.add("width", view.size.width);
    report.add("height", view.size.height);
    add_counters(first.statistics, last, report);
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
