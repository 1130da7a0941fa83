// Animated scenes over a ground: every frame moved, voxelized, its pyramid built, and soft shadow rays traced
// (Forest et al. 2009: "fully dynamic scenes").
#include <algorithm>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "reference/shadow_truth.h"
#include "renderer/shadow_renderer.h"
#include "scenes/ground.h"
#include "scenes/load.h"

namespace cairn::bench {
namespace {

constexpr int width = 320;
constexpr int height = 240;
constexpr double frames_per_second = 30.0;
constexpr int frames_per_run = 4;  // frames per run that --runs asks for, or all frames
constexpr std::size_t checked_frames = 3;
constexpr double truth_error = 1.0 / 256;  // far below the error of the voxels

/// At most `most` of the times, evenly spaced.
std::vector<double> thinned(const std::vector<double>& times, std::size_t most) {
    if (times.size() <= most) return times;
    std::vector<double> some;
    for (std::size_t i = 0; i < most; ++i)
        some.push_back(times[i * times.size() / most]);
    return some;
}

/// A scene with its ground, and Embree's pictures of it at some moments.
class MovingScene {
public:
    MovingScene(const std::string& path, int runs) : scene_(scenes::load(path)) {
        if (scene_.animations.empty())
            throw Error(Fault::usage, path, "it has no animation", "choose an animated scene");
        when_.animation = 0;
        voxelized_ = scenes::bounds_over_animation(scene_, when_, frames_per_second);
        scenes::add_ground(scene_, voxelized_);
        first_ = scenes::take_snapshot(scene_, when_);
        times_ = thinned(scenes::frame_times(scene_, when_, frames_per_second),
                         std::size_t(frames_per_run) * std::size_t(runs));
        view_.size = {width, height};
        // The ground receives shadows outside the grid too, and casts none.
        view_.camera = optics::framing_camera(voxelized_, double(width) / height);
        const double size = 2.0 * glm::length(voxelized_.high - voxelized_.low);
        view_.light.positional = true;
        view_.light.position = 0.5 * (voxelized_.low + voxelized_.high) + size * glm::dvec3(0.5, 0.9, 0.3);
        view_.light.radius = 0.1 * size;
        find_truths();
    }

    struct Truth {
        double seconds = 0.0;
        std::vector<float> hard, soft;
    };

    [[nodiscard]] std::unique_ptr<renderer::ShadowRenderer> make(int resolution,
                                                                 const gl::ShaderSource& shaders) const {
        return renderer::make_shadow_renderer(
            renderer::ShadowMethod::pyramid,
            {.scene = scene_, .snapshot = first_, .motion = renderer::ShadowMotion{when_, voxelized_}},
            {.pyramid = {.resolution = resolution}}, shaders);
    }
    [[nodiscard]] renderer::View view(int rays) const {
        renderer::View view = view_;
        view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
        return view;
    }
    [[nodiscard]] const std::vector<double>& times() const { return times_; }
    [[nodiscard]] const std::vector<Truth>& truths() const { return truths_; }
    [[nodiscard]] std::int64_t triangles() const {
        return std::int64_t(scenes::take_snapshot(scene_, when_).triangle_count);
    }

private:
    void find_truths() {
        const scenes::NodeSelection all(scene_.nodes.size(), true);
        for (const double seconds : thinned(times_, checked_frames)) {
            scenes::When then = when_;
            then.seconds = seconds;
            const scenes::Snapshot snapshot = scenes::take_snapshot(scene_, then);
            const reference::ImageTracer tracer(scene_, snapshot);
            const reference::ShadowQuestion question{scene_,      snapshot, all,   view_.camera,
                                                     view_.light, width,    height};
            const reference::ShadowReceivers receivers = reference::shadow_receivers(tracer, question);
            truths_.push_back(
                {seconds, reference::hard_shares(receivers),
                 reference::soft_shares(tracer, question, receivers, {.standard_error = truth_error})
                     .shares});
        }
    }

    scenes::Scene scene_;
    scenes::When when_;
    scenes::Snapshot first_;
    scenes::Bounds voxelized_;
    std::vector<double> times_;
    renderer::View view_;
    std::vector<Truth> truths_;
};

using renderer::ShadowTimes;

double median_of(const std::vector<ShadowTimes>& frames, double ShadowTimes::*part) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const ShadowTimes& frame : frames)
        values.push_back(frame.*part);
    return median(std::move(values));
}

const renderer::ShadowRequest only_image = {.light = false};
const renderer::ShadowRequest only_light = {.image = false};

/// Measures frames of one size and number of rays, and their error.
std::vector<Cell> measure(const MovingScene& scene, renderer::ShadowRenderer& renderer, int rays,
                          double budget_ms) {
    const renderer::View view = scene.view(rays);
    renderer.move_to(scene.times().front());
    (void)renderer.render(view, only_image);  // the driver compiles programs at their first use
    std::vector<ShadowTimes> frames;
    std::vector<double> processor_ms;
    double spent_ms = 0.0;
    for (const double seconds : scene.times()) {
        if (spent_ms > budget_ms) break;
        const std::clock_t processor = std::clock();
        renderer.move_to(seconds);
        frames.push_back(renderer.render(view, only_image).times);
        processor_ms.push_back(1000.0 * double(std::clock() - processor) / CLOCKS_PER_SEC);
        spent_ms += frames.back().milliseconds;
    }
    double rmse = 0.0;
    double wrong = 0.0;
    for (const MovingScene::Truth& truth : scene.truths()) {
        renderer.move_to(truth.seconds);
        const auto error = reference::shadow_error(renderer.render(view, only_light).light.shares,
                                                   rays == 1 ? truth.hard : truth.soft);
        rmse += error.rmse() / double(scene.truths().size());
        wrong += error.disagreement() / double(scene.truths().size());
    }
    return {std::int64_t(rays),
            std::int64_t(frames.size()),
            median_of(frames, &ShadowTimes::move_ms),
            median_of(frames, &ShadowTimes::voxelize_ms),
            median_of(frames, &ShadowTimes::pyramid_ms),
            median_of(frames, &ShadowTimes::raster_ms),
            median_of(frames, &ShadowTimes::trace_ms),
            median_of(frames, &ShadowTimes::milliseconds),
            median(processor_ms),
            std::int64_t(frames.back().pyramid_bytes),
            std::int64_t(scene.truths().size()),
            rmse,
            wrong};
}

}  // namespace

Chart chart_moving_shadow(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",         "triangles", "resolution",  "rays",
                           "frames",        "move_ms",   "voxelize_ms", "pyramid_ms",
                           "raster_ms",     "trace_ms",  "ms",          "processor_ms",
                           "pyramid_bytes", "checked",   "rmse",        "hard_disagreement",
                           "driver",        "threads"};
    std::vector<std::string> paths = options.scenes;
    if (paths.empty()) {
        add_real_scenes(chart, options,
                        {"CesiumMan.glb", "Fox.glb", "MorphStressTest/MorphStressTest.gltf",
                         "InterpolationTest/InterpolationTest.gltf"},
                        paths);
    }
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{128, 256, 512} : options.resolutions;
    constexpr int ray_counts[] = {1, 16, 64};
    double done = 0.0;
    for (const std::string& path : paths) {
        const MovingScene scene(path, options.runs);
        for (const int resolution : resolutions) {
            const auto renderer = scene.make(resolution, options.shaders);
            for (const int rays : ray_counts) {
                std::vector<Cell> row{scene_name(path), scene.triangles(), std::int64_t(resolution)};
                for (Cell& cell : measure(scene, *renderer, rays, options.budget_ms))
                    row.push_back(std::move(cell));
                chart.table.rows.push_back(on_this_machine(std::move(row)));
            }
            done += 1.0 / double(paths.size() * resolutions.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "moving_shadow");
    return chart;
}

}  // namespace cairn::bench
