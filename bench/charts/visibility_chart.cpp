// The bricks that are produced for a first frame if rays report what they miss, if occlusion queries on the
// tiles in the frustum decide (Crassin 2007, section 3.6), and if the frustum decides alone.
#include <array>
#include <functional>
#include <utility>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/peers/occlusion_queries.h"
#include "bench/trials/frame_case.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 256;
constexpr double nearest = 0.25;  // share of the distance from which the whole is seen
constexpr std::size_t most_pool_bytes = std::size_t(2) << 30U;

constexpr std::size_t sample_pool_bytes = std::size_t(4) << 20U;

/// Figures of a scheme in one run.
struct Outcome {
    std::uint64_t produced = 0;
    std::uint64_t used = 0;
    std::uint64_t missed = 0;
    std::uint64_t queries = 0;
    int passes = 0;
    double milliseconds = 0.0;
};

/// A view along the longest horizontal axis, from its end and low in the scene, so that much is hidden behind
/// other things.
renderer::View through(const scenes::Bounds& bounds, renderer::View view) {
    const glm::dvec3 size = bounds.high - bounds.low;
    const int along = size.x >= size.z ? 0 : 2;
    view.camera.eye = bounds.low + glm::dvec3(0.5, 0.2, 0.5) * size;
    view.camera.target = view.camera.eye;
    view.camera.eye[along] = bounds.high[along] + 0.02 * size[along];
    view.camera.target[along] = bounds.low[along];
    return view;
}

class Comparison {
public:
    Comparison(const ChartOptions& options, const FrameCase& frame_case, int size, Chart& chart)
        : options_(options), case_(frame_case), size_(size), chart_(chart) {}

    void compare(const char* name, renderer::View view) {
        // Tests of boxes from the eye say nothing about shadow rays.
        view.shadow.kind = renderer::ShadowQuality::Kind::none;
        pool_bytes_ = bytes_for_frustum(view);
        auto queries = [&](bool overlapped) {
            return [=, this] { return of(bricks(view)->by_queries({.overlapped = overlapped})); };
        };
        const std::pair<const char*, std::function<Outcome()>> schemes[] = {
            {"ray-guided", [&] { return by_rays(view); }},
            {"occlusion-query", queries(true)},
            {"occlusion-query-waiting", queries(false)},
            {"frustum", [&] { return of(bricks(view)->by_frustum()); }},
        };
        for (const auto& [scheme, run] : schemes)
            measure(name, scheme, run);
    }

private:
    [[nodiscard]] Outcome by_rays(const renderer::View& view) const {
        const FrameContender contender(
            case_.make(tree(), options_.shaders,
                       options_.voxels.renderer({.pools = {.brick_bytes = pool_bytes_}})),
            view);
        const renderer::FrameStatistics& first = contender.first;
        const renderer::FrameStatistics last = marched_frame(*contender.renderer, view).statistics;
        return {first.bricks_produced, last.bricks_used, 0, 0, first.passes, first.milliseconds};
    }

    [[nodiscard]] std::unique_ptr<VisibleBricks> bricks(const renderer::View& view) const {
        const renderer::TreeOptions options = tree();
        return std::make_unique<VisibleBricks>(case_.content(options, options_.shaders), case_.shape(options),
                                               view, pool_bytes_, options_.shaders);
    }

    [[nodiscard]] static Outcome of(const Visibility& found) {
        return {found.bricks_produced, found.bricks_used, found.missed,
                found.queries,         found.batches,     found.milliseconds};
    }

    [[nodiscard]] renderer::TreeOptions tree() const { return case_.fitted(options_.voxels.tree()); }

    /// Bytes of a pool for all bricks that could be produced, if the driver allows one. It is no larger,
    /// because drivers clear pools.
    [[nodiscard]] std::size_t bytes_for_frustum(const renderer::View& view) const {
        const renderer::TreeShape shape = case_.shape(tree());
        const std::unique_ptr<renderer::Content> content = case_.content(tree(), options_.shaders);
        const std::size_t sample_bytes =
            std::max(sample_pool_bytes, renderer::least_packed_bytes(shape, content->has_color()));
        const renderer::BrickPool sample(shape, content->channels(), sample_bytes);
        // A packed pool has slots for bricks of few voxels.
        const std::size_t slot_bytes =
            sample.size_bytes() / std::size_t(sample.slot_count()) * (content->channels().packed ? 4 : 1);
        const std::size_t tiles = tiles_in_frustum(*content, shape, view);
        return std::min(slot_bytes * (tiles + tiles / 4 + 64), most_pool_bytes);
    }

    void measure(const char* view, const char* scheme, const std::function<Outcome()>& run) {
        std::vector<double> ms;
        double spent_ms = 0.0;
        Outcome last;
        try {
            for (int i = 0; i < options_.runs && spent_ms <= options_.budget_ms; ++i) {
                last = run();
                ms.push_back(last.milliseconds);
                spent_ms += ms.back();
            }
        } catch (const Error& error) {
            if (error.fault() != Fault::usage) throw;
            chart_.notes.push_back(case_.name() + ", " + view + ", " + scheme +
                                   " is left out: " + error.what());
            return;
        }
        const double used = double(std::max<std::uint64_t>(last.used, 1));
        chart_.table.rows.push_back(on_this_machine(
            {case_.name(), std::string(view), std::string(scheme), std::int64_t(size_),
             std::int64_t(last.produced), std::int64_t(last.used), double(last.produced) / used,
             std::int64_t(last.missed), std::int64_t(last.queries), std::int64_t(last.passes), median(ms)}));
    }

    const ChartOptions& options_;
    const FrameCase& case_;
    int size_;
    std::size_t pool_bytes_ = 0;  // bytes of the brick pool for the view
    Chart& chart_;
};

}  // namespace

Chart chart_visibility(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {
        "scene",  "view",    "scheme", "size", "bricks_produced", "bricks_used", "produced_over_used",
        "missed", "queries", "passes", "ms",   "driver",          "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:knot", "builtin:spheres", "builtin:tree"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb", "kaykit_city.glb"}, scenes);
    }
    const std::vector<int> sizes =
        options.resolutions.empty() ? std::vector<int>{own_size} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const FrameCase frame_case(scene);
        for (const int size : sizes) {
            Comparison comparison(options, frame_case, size, chart);
            const renderer::View whole = frame_case.view(size, size);
            renderer::View near = whole;
            near.camera.eye = whole.camera.target + nearest * (whole.camera.eye - whole.camera.target);
            for (const auto& [name, view] : {std::pair("whole", whole), std::pair("near", near),
                                             std::pair("through", through(frame_case.bounds(), whole))}) {
                comparison.compare(name, view);
                done += 1.0 / (3.0 * double(scenes.size() * sizes.size()));
                if (options.progress) options.progress(done);
            }
        }
    }
    write_table(chart, options.folder, "visibility");
    return chart;
}

}  // namespace cairn::bench
