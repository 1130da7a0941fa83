// The bricks that the first frame of a scene produces, and how many of them rays use once nothing is missing:
// an oracle with perfect knowledge would have produced no others.
#include <algorithm>

#include "bench/charts/chart.h"
#include "bench/trials/frame_case.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 512;

/// A row of the table. Each run begins with empty pools.
std::vector<Cell> measure(const FrameCase& frame_case, int size, const ChartOptions& options) {
    std::vector<double> first_ms, produce_ms, tree_ms, upload_ms, brick_ms;
    std::vector<FrameContender> last;
    for (int run = 0; run < options.runs; ++run) {
        last.clear();
        last.emplace_back(frame_case.make(options.voxels.tree(), options.shaders, options.voxels.renderer(),
                                          options.voxels.volume()),
                          frame_case.view(size, size));
        const renderer::FrameStatistics& first = last.back().first;
        first_ms.push_back(first.milliseconds);
        produce_ms.push_back(first.produce_ms);
        tree_ms.push_back(first.tree_ms);
        upload_ms.push_back(first.upload_ms);
        brick_ms.push_back((first.produce_ms - first.tree_ms - first.upload_ms) /
                           double(std::max<std::uint64_t>(first.bricks_produced, 1)));
    }
    measure_in_turn(last, 1, options.budget_ms);
    const renderer::FrameStatistics& first = last.back().first;
    const auto used = double(std::max<std::uint64_t>(last.back().converged.bricks_used, 1));
    return on_this_machine({frame_case.name(), frame_case.triangles(), std::int64_t(size), median(first_ms),
                            median(produce_ms), median(tree_ms), median(upload_ms), median(brick_ms),
                            std::int64_t(first.bricks_produced), std::int64_t(first.constant_tiles),
                            std::int64_t(last.back().converged.bricks_used),
                            double(first.bricks_produced) / used, std::int64_t(first.passes),
                            std::int64_t(first.nodes_subdivided)});
}

}  // namespace

Chart chart_production(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",           "triangles",      "size",        "first_ms",
                           "produce_ms",      "tree_ms",        "upload_ms",   "brick_ms",
                           "bricks_produced", "constant_tiles", "bricks_used", "produced_over_used",
                           "passes",          "nodes",          "driver",      "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:cornell", "builtin:knot", "builtin:tree", "builtin:hollow-sphere"};
        add_real_scenes(chart, options, {engine_path, "stanford_bunny_69k.glb", "stanford_dragon_871k.glb"},
                        scenes);
    }
    check_volume_options(chart, options, scenes);
    const std::vector<int> sizes =
        options.resolutions.empty() ? std::vector<int>{own_size} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const FrameCase frame_case(scene);
        for (const int size : sizes) {
            chart.table.rows.push_back(measure(frame_case, size, options));
            done += 1.0 / double(scenes.size() * sizes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "production");
    return chart;
}

}  // namespace cairn::bench
