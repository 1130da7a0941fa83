// A converged frame with hard shadows beside Embree's single rays: same triangles, camera, light and cores.
// The two are measured in turn, so that the ratio holds when the machine's speed drifts.
#include <thread>

#include "bench/chart.h"
#include "bench/samples.h"
#include "gl/context.h"
#include "reference/image.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

std::vector<Cell> measure(const std::string& path, int size, const ChartOptions& options) {
    const std::string name = std::filesystem::path(path).filename().string();
    const scenes::Scene scene = scenes::load(path);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    renderer::Renderer ours(scene, snapshot, {}, options.shaders);
    renderer::View view;
    view.width = view.height = size;
    view.camera = renderer::framing_camera(snapshot.bounds, 1.0);
    const reference::ReferenceCamera camera{view.camera.eye, view.camera.target, view.camera.up,
                                            view.camera.yfov};
    reference::ReferenceLight light;
    light.towards = view.light.towards;
    reference::ImageTracer embree(scene, snapshot);

    (void)ours.render(view);
    const double first_ms = ours.statistics().milliseconds;
    const std::uint64_t bricks = ours.statistics().bricks_produced;
    std::vector<double> ours_ms;
    std::vector<double> embree_ms;
    std::vector<double> ratio;
    for (int i = 0; i < options.runs; ++i) {
        ours.forget_picture();
        (void)ours.render(view);
        ours_ms.push_back(ours.statistics().milliseconds);
        embree_ms.push_back(embree.trace(camera, light, size, size).milliseconds);
        ratio.push_back(ours_ms.back() / embree_ms.back());
    }
    return {name,
            std::int64_t(size),
            first_ms,
            std::int64_t(bricks),
            median(ours_ms),
            median(embree_ms),
            median(ratio),
            gl::driver_name(),
            std::int64_t(std::thread::hardware_concurrency())};
}

}  // namespace

Chart chart_render(const ChartOptions& options) {
    const std::vector<std::string> scenes =
        options.scenes.empty() ? std::vector<std::string>{"builtin:knot", "builtin:spheres", "builtin:tree"}
                               : options.scenes;
    const std::vector<int> sizes = options.resolutions.empty() ? std::vector<int>{512} : options.resolutions;
    Chart chart;
    chart.table.columns = {"scene",     "size",  "first_ms", "bricks", "converged_ms",
                           "embree_ms", "ratio", "driver",   "threads"};
    double done = 0.0;
    for (const std::string& scene : scenes) {
        for (const int size : sizes) {
            chart.table.rows.push_back(measure(scene, size, options));
            done += 1.0 / double(scenes.size() * sizes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_file(chart, options.folder, "render.csv", csv_of(chart.table));
    return chart;
}

}  // namespace cairn::bench
