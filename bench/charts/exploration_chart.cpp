// Crassin et al. 2008, Figure 7: the cost of a frame at three distances, and of the frames of a camera that
// moves closer: rays, production, passes, uploads, the tree.
#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/charts/chart.h"
#include "bench/peers/view_tiles.h"
#include "bench/trials/frame_case.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "renderer/march/march_view.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 256;
constexpr int own_frames = 24;
constexpr double nearest = 0.25;  // share of the distance from which the whole is seen
constexpr double voxels_per_frame = 4.0;

/// Figures of a frame, as columns of the table.
struct Figures {
    double render_ms = 0.0;
    double bricks_ms = 0.0;
    double upload_ms = 0.0;
    double tree_ms = 0.0;
    double bricks = 0.0;
    double passes = 0.0;
    double ms = 0.0;

    /// Adds the figures of a frame, times `share`.
    void add(const renderer::FrameStatistics& s, double share) {
        render_ms += share * s.march_ms;
        bricks_ms += share * (s.produce_ms - s.tree_ms - s.upload_ms);
        upload_ms += share * s.upload_ms;
        tree_ms += share * s.tree_ms;
        bricks += share * double(s.bricks_produced);
        passes += share * double(s.passes);
        ms += share * s.milliseconds;
    }
};

/// The view with its eye at a share of the distance.
renderer::View at(renderer::View view, double share) {
    view.camera.eye = view.camera.target + share * (view.camera.eye - view.camera.target);
    return view;
}

class Explorer {
public:
    Explorer(const ChartOptions& options, int size, Chart& chart)
        : options_(options), size_(size), chart_(chart) {}

    void explore(const FrameCase& frame_case) {
        const renderer::View view = frame_case.view(size_, size_);
        renderer::Renderer ours = make(frame_case);
        (void)ours.render(view);
        move_closer(frame_case, ours, view);
        go_steadily(frame_case, at(view, nearest));
        for (const auto& [name, share] :
             {std::pair("far", 2.0), std::pair("whole", 1.0), std::pair("near", nearest)})
            stand(frame_case, name, ours, at(view, share));
    }

private:
    [[nodiscard]] renderer::Renderer make(const FrameCase& frame_case) const {
        const VoxelOptions& voxels = options_.voxels;
        return frame_case.make(voxels.tree(), options_.shaders, voxels.renderer(), voxels.volume());
    }

    /// Measures converged frames.
    void stand(const FrameCase& frame_case, const char* part, renderer::Renderer& ours,
               const renderer::View& view) {
        renderer::FrameStatistics last;
        (void)ours.render(view);
        std::vector<double> ms, march_ms;
        double spent_ms = 0.0;
        for (int run = 0; run < options_.runs && spent_ms <= options_.budget_ms; ++run) {
            last = marched_frame(ours, view, options_.voxels.request()).statistics;
            ms.push_back(last.milliseconds);
            spent_ms += ms.back();
            march_ms.push_back(last.march_ms);
        }
        Figures figures;
        figures.add(last, 1.0);
        figures.render_ms = median(march_ms);
        figures.ms = median(ms);
        add(frame_case, part, 1, figures);
    }

    /// Moves the camera closer. Figures are means over the frames, without the first one, into empty pools.
    void move_closer(const FrameCase& frame_case, renderer::Renderer& ours, const renderer::View& view) {
        Figures mean;
        for (int frame = 1; frame <= own_frames; ++frame) {
            const renderer::View next = at(view, std::pow(nearest, double(frame) / own_frames));
            mean.add(ours.render(next, options_.voxels.request()).statistics, 1.0 / own_frames);
        }
        add(frame_case, "exploration", own_frames, mean);
    }

    /// Moves the camera straight ahead by four voxels of the nearest tile per frame, the speed of Crassin et
    /// al. 2008, Figure 7. They relax it over time: it drops at once where voxels become finer, and rises
    /// slowly.
    void go_steadily(const FrameCase& frame_case, renderer::View view) {
        const std::unique_ptr<renderer::Content> content =
            frame_case.content(options_.voxels.tree(), options_.shaders);
        const renderer::TreeShape shape = frame_case.shape(options_.voxels.tree());
        renderer::Renderer ours = make(frame_case);
        (void)ours.render(view);
        Figures mean;
        double step = 0.0;
        for (int frame = 1; frame <= own_frames; ++frame) {
            const ViewTest test(renderer::march_view(view, content->grid(), shape, nullptr), shape);
            const double side = nearest_voxel_side(content->oracle(), test).value_or(0.0);
            const double wanted = voxels_per_frame * side * content->grid().voxel_size;
            step = frame == 1 ? wanted : std::min(wanted, std::sqrt(step * wanted));
            const glm::dvec3 way = step * glm::normalize(view.camera.target - view.camera.eye);
            view.camera.eye += way;
            view.camera.target += way;
            mean.add(ours.render(view, options_.voxels.request()).statistics, 1.0 / own_frames);
        }
        add(frame_case, "steady", own_frames, mean);
    }

    void add(const FrameCase& frame_case, const char* part, int frames, const Figures& f) {
        chart_.table.rows.push_back(on_this_machine(
            {frame_case.name(), std::string(part), std::int64_t(size_), std::int64_t(frames), f.render_ms,
             f.bricks_ms, f.bricks, f.passes, f.upload_ms, f.tree_ms, f.ms, 1000.0 / f.ms}));
    }

    const ChartOptions& options_;
    int size_;
    Chart& chart_;
};

}  // namespace

Chart chart_exploration(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",  "part",   "size",      "frames",  "render_ms", "bricks_ms",
                           "bricks", "passes", "upload_ms", "tree_ms", "ms",        "frames_a_second",
                           "driver", "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:hollow-sphere", "builtin:sponge", "builtin:tree"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb"}, scenes);
    }
    check_volume_options(chart, options, scenes);
    const std::vector<int> sizes =
        options.resolutions.empty() ? std::vector<int>{own_size} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const FrameCase frame_case(scene);
        for (const int size : sizes) {
            Explorer(options, size, chart).explore(frame_case);
            done += 1.0 / double(scenes.size() * sizes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "exploration");
    return chart;
}

}  // namespace cairn::bench
