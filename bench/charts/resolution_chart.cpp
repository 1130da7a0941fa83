// One view at rising resolutions: the cost of a converged frame, and the bricks in the pools.
#include <memory>

#include "bench/charts/chart.h"
#include "bench/trials/frame_case.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/samples.h"

namespace cairn::bench {
namespace {

/// The resolutions of this tree are the powers of 4 times 32.
constexpr renderer::TreeOptions tree{.n = 4, .m = 32};
constexpr std::size_t pool_bytes = std::size_t(128) << 20U;
constexpr int picture = 512;  // pixels per side
/// The second view, from the same place, has a field of view divided by this, so that pixels see voxels finer
/// by the same factor.
constexpr double narrowed = 16.0;

using Renderers = std::vector<std::shared_ptr<renderer::Renderer>>;

Renderers renderers_of(const FrameCase& frame_case, const std::vector<int>& resolutions,
                       const ChartOptions& options) {
    Renderers made;
    for (const int resolution : resolutions) {
        renderer::TreeOptions finer = tree;
        finer.max_resolution = resolution;
        made.push_back(std::make_shared<renderer::Renderer>(frame_case.make(
            finer, options.shaders, options.voxels.renderer({.pools = {.brick_bytes = pool_bytes}}),
            options.voxels.volume())));
    }
    return made;
}

void measure(const FrameCase& frame_case, const Renderers& renderers, const std::vector<int>& resolutions,
             bool near, const ChartOptions& options, Table& table) {
    renderer::View view = frame_case.view(picture, picture);
    if (near) view.camera.yfov /= narrowed;
    std::vector<FrameContender> contenders;
    for (const auto& ours : renderers)
        contenders.emplace_back(ours, view);
    measure_in_turn(contenders, options.runs, options.budget_ms);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const FrameContender& contender = contenders[i];
        std::vector<double> growth;
        for (std::size_t run = 0; run < contender.samples_ms.size(); ++run)
            growth.push_back(contender.samples_ms[run] / contenders.front().samples_ms[run]);
        const renderer::FrameStatistics& s = contender.converged;
        table.rows.push_back(
            on_this_machine({frame_case.name(), std::string(near ? "near" : "whole"),
                             std::int64_t(resolutions[i]), median(contender.samples_ms), median(growth),
                             contender.first_ms, std::int64_t(contender.first.bricks_produced),
                             std::int64_t(s.bricks_used), std::int64_t(s.bricks_resident),
                             std::int64_t(s.brick_slots), std::int64_t(contender.first.bricks_evicted),
                             std::int64_t(s.brick_pool_bytes), std::int64_t(s.node_pool_bytes)}));
    }
}

}  // namespace

Chart chart_resolution(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",           "view",        "resolution",      "ms",
                           "growth",          "first_ms",    "bricks_produced", "bricks_used",
                           "bricks_resident", "brick_slots", "bricks_evicted",  "brick_pool_bytes",
                           "node_pool_bytes", "driver",      "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) scenes = {"builtin:hollow-sphere", "builtin:spheres-repeated", "builtin:knot"};
    check_volume_options(chart, options, scenes);
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{512, 2048, 8192, 32768} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const FrameCase frame_case(scene);
        const Renderers renderers = renderers_of(frame_case, resolutions, options);
        for (const bool near : {false, true}) {
            measure(frame_case, renderers, resolutions, near, options, chart.table);
            done += 0.5 / double(scenes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "resolution");
    return chart;
}

}  // namespace cairn::bench
