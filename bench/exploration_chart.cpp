// Crassin et al. 2008, Figure 7: the cost of a frame at three distances, and of the frames of a camera that
// comes nearer: rays, production, passes, the tree.
#include <cmath>
#include <utility>

#include "bench/chart.h"
#include "bench/frames.h"
#include "bench/real_scenes.h"
#include "bench/samples.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 256;
constexpr int own_frames = 24;
constexpr double nearest = 0.25;  // of the distance from which the whole is seen

/// Its eye at a share of the distance.
renderer::View at(renderer::View view, double share) {
    view.camera.eye = view.camera.target + share * (view.camera.eye - view.camera.target);
    return view;
}

class Explorer {
public:
    Explorer(const ChartOptions& options, int size, Chart& chart)
        : options_(options), size_(size), chart_(chart) {}

    void explore(const Subject& subject) {
        const renderer::View view = subject.view(size_, size_);
        renderer::Renderer ours = subject.make({}, options_.shaders);
        (void)ours.render(view);
        come_nearer(subject, ours, view);
        for (const auto& [name, share] :
             {std::pair("far", 2.0), std::pair("whole", 1.0), std::pair("near", nearest)})
            stand(subject, name, ours, at(view, share));
    }

private:
    /// Converged frames.
    void stand(const Subject& subject, const char* part, renderer::Renderer& ours,
               const renderer::View& view) {
        (void)ours.render(view);
        std::vector<double> ms, march_ms;
        double spent_ms = 0.0;
        for (int run = 0; run < options_.runs && spent_ms <= options_.budget_ms; ++run) {
            ms.push_back(frame_ms(ours, view));
            spent_ms += ms.back();
            march_ms.push_back(ours.statistics().march_ms);
        }
        const renderer::FrameStatistics& s = ours.statistics();
        add(subject, part, 1,
            {median(march_ms), s.produce_ms - s.tree_ms, s.tree_ms, double(s.bricks_produced),
             double(s.passes), median(ms)});
    }

    /// Means over the frames; the first, into empty pools, is not one of them.
    void come_nearer(const Subject& subject, renderer::Renderer& ours, const renderer::View& view) {
        std::vector<double> sums(6, 0.0);
        for (int frame = 1; frame <= own_frames; ++frame) {
            (void)ours.render(at(view, std::pow(nearest, double(frame) / own_frames)));
            const renderer::FrameStatistics& s = ours.statistics();
            const std::vector<double> figures = {s.march_ms,       s.produce_ms - s.tree_ms,
                                                 s.tree_ms,        double(s.bricks_produced),
                                                 double(s.passes), s.milliseconds};
            for (std::size_t i = 0; i < sums.size(); ++i)
                sums[i] += figures[i] / own_frames;
        }
        add(subject, "exploration", own_frames, sums);
    }

    /// @param figures  march, bricks, tree, number of bricks, passes, all
    void add(const Subject& subject, const char* part, int frames, const std::vector<double>& figures) {
        std::vector<Cell> row{subject.name(), std::string(part), std::int64_t(size_), std::int64_t(frames)};
        row.insert(row.end(), figures.begin(), figures.end());
        row.emplace_back(1000.0 / figures.back());
        chart_.table.rows.push_back(on_this_machine(std::move(row)));
    }

    const ChartOptions& options_;
    int size_;
    Chart& chart_;
};

}  // namespace

Chart chart_exploration(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",  "part",   "size", "frames",          "render_ms", "bricks_ms", "tree_ms",
                           "bricks", "passes", "ms",   "frames_a_second", "driver",    "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:hollow-sphere", "builtin:tree"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb"}, scenes);
    }
    const std::vector<int> sizes =
        options.resolutions.empty() ? std::vector<int>{own_size} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const Subject subject(scene);
        for (const int size : sizes) {
            Explorer(options, size, chart).explore(subject);
            done += 1.0 / double(scenes.size() * sizes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_file(chart, options.folder, "exploration.csv", csv_of(chart.table));
    return chart;
}

}  // namespace cairn::bench
