#include <algorithm>
#include <map>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/plots/voxelize_plot.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "bench/trials/voxel_contenders.h"
#include "gl/context.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

/// Up to this resolution the slow exact reference is the truth. Beyond it, the CPU's row spans are, provided
/// that the same run has found none of their voxels missing or extra in this scene.
constexpr int largest_reference = 512;
constexpr int smallest_pyramid = 512;
/// A contender that took longer than this for one run is left out at higher resolutions.
constexpr double longest_run_ms = 10000.0;

/// Figures of one contender at one resolution.
struct Result {
    std::vector<double> samples_ms;
    double spent_ms = 0.0;
    std::optional<reference::Comparison> comparison;
    std::uint64_t occupied = 0;
};

class Runner {
public:
    Runner(const ChartOptions& options, Chart& chart)
        : options_(options), chart_(chart), contenders_(options.shaders), driver_(gl::driver_name()) {
        chart_.table.columns = {"scene", "resolution", "method", "triangles", "occupied", "missing",
                                "extra", "error",      "ms",     "threads",   "driver"};
    }

    /// @param done  called after each resolution
    void measure(const std::string& name, const std::vector<int>& resolutions,
                 const std::function<void()>& done) {
        const scenes::Scene scene = scenes::load(name);
        const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
        const std::string label = scene_name(name);
        last_ms_.clear();
        row_spans_exact_ = false;
        for (const int resolution : resolutions) {
            measure(label, voxelizer::build_surface(scene, snapshot,
                                                    voxelizer::grid_around(snapshot.bounds, resolution)));
            done();
        }
    }

private:
    void measure(const std::string& scene, const voxelizer::Surface& surface) {
        const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
        const voxelizer::Region region = voxelizer::whole(surface.grid);
        const VoxelCase voxel_case{surface, on_gpu, region};
        std::vector<VoxelContender> all = contenders_.at(voxel_case);
        std::erase_if(all, [&](const VoxelContender& c) { return takes_too_long(c, scene, region.size.x); });
        const voxelizer::BitGrid truth = truth_of(voxel_case, all);
        std::vector<Result> results(all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            first_run(all[i], results[i], truth, scene);
        // Contenders run in turn, so that ratios hold if the machine's speed drifts.
        for (int run = 0; run < options_.runs; ++run) {
            for (std::size_t i = 0; i < all.size(); ++i)
                run_again(all[i], results[i]);
        }
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!results[i].samples_ms.empty()) add_row(scene, voxel_case, all[i], results[i]);
        }
        if (region.size.x >= smallest_pyramid) add_pyramid(scene, voxel_case);
    }

    [[nodiscard]] bool takes_too_long(const VoxelContender& contender, const std::string& scene,
                                      int resolution) {
        const auto last = last_ms_.find(contender.name);
        if (last == last_ms_.end()) return false;
        if (last->second.second <= longest_run_ms) return false;
        chart_.notes.push_back(fmt::format("{} at {}: {} is left out, as it took {:.0f} s at {}", scene,
                                           resolution, contender.name, last->second.second / 1000.0,
                                           last->second.first));
        return true;
    }

    [[nodiscard]] voxelizer::BitGrid truth_of(const VoxelCase& voxel_case,
                                              const std::vector<VoxelContender>& all) const {
        const auto row_spans = std::find_if(
            all.begin(), all.end(), [](const VoxelContender& c) { return c.name == cpu_row_span_name; });
        if (voxel_case.region.size.x <= largest_reference || !row_spans_exact_ || row_spans == all.end())
            return reference::exact_voxels(voxel_case.surface, voxel_case.region);
        voxelizer::BitGrid truth;
        row_spans->run(&truth);
        return truth;
    }

    /// The first run, which compiles programs, and the comparison with the truth. Its time counts only if
    /// there is no time for a second run.
    void first_run(const VoxelContender& contender, Result& result, const voxelizer::BitGrid& truth,
                   const std::string& scene) {
        try {
            voxelizer::BitGrid voxels;
            result.spent_ms = contender.run(contender.finds_voxels ? &voxels : nullptr);
            if (result.spent_ms > options_.budget_ms) result.samples_ms.push_back(result.spent_ms);
            if (contender.finds_voxels) {
                result.comparison = reference::compare(voxels, truth);
                result.occupied = voxels.count();
            }
        } catch (const Error& error) {
            if (error.fault() != Fault::memory && error.fault() != Fault::usage) throw;
            chart_.notes.push_back(fmt::format("{}: {} left out; {}", scene, contender.name, error.what()));
            result.spent_ms = -1.0;
        }
    }

    void run_again(const VoxelContender& contender, Result& result) const {
        const bool enough = !result.samples_ms.empty() && result.spent_ms > options_.budget_ms;
        if (result.spent_ms < 0.0 || enough) return;
        result.samples_ms.push_back(contender.run(nullptr));
        result.spent_ms += result.samples_ms.back();
    }

    void add_row(const std::string& scene, const VoxelCase& voxel_case, const VoxelContender& contender,
                 const Result& result) {
        const double ms = median(result.samples_ms);
        const int resolution = voxel_case.region.size.x;
        last_ms_[contender.name] = {resolution, ms};
        std::vector<Cell> row{scene, std::int64_t(resolution), contender.name,
                              std::int64_t(voxel_case.surface.triangle_count)};
        if (result.comparison) {
            const reference::Comparison& c = *result.comparison;
            const bool exact = c.missing + c.extra == 0;
            if (contender.name == cpu_row_span_name && resolution <= largest_reference)
                row_spans_exact_ = exact;
            const double share = c.occupied > 0 ? double(c.missing + c.extra) / double(c.occupied) : 0.0;
            row.insert(row.end(), {std::int64_t(result.occupied), std::int64_t(c.missing),
                                   std::int64_t(c.extra), share});
        } else {
            row.insert(row.end(), 4, Cell{});
        }
        row.insert(row.end(), {ms, threads_, contender.driver});
        chart_.table.rows.push_back(std::move(row));
    }

    void add_pyramid(const std::string& scene, const VoxelCase& voxel_case) {
        std::vector<double> samples;
        samples.reserve(std::size_t(std::max(options_.runs, 0)));
        (void)contenders_.pyramid_ms(voxel_case);
        for (int run = 0; run < options_.runs; ++run)
            samples.push_back(contenders_.pyramid_ms(voxel_case));
        chart_.table.rows.push_back({scene, std::int64_t(voxel_case.region.size.x), std::string("pyramid"),
                                     std::int64_t(voxel_case.surface.triangle_count), Cell{}, Cell{}, Cell{},
                                     Cell{}, median(samples), threads_, driver_});
    }

    const ChartOptions& options_;
    Chart& chart_;
    VoxelContenders contenders_;
    std::string driver_;
    std::int64_t threads_ = std::int64_t(std::thread::hardware_concurrency());
    std::map<std::string, std::pair<int, double>> last_ms_;  ///< resolution and time of each contender
    bool row_spans_exact_ = false;
};

}  // namespace

Chart chart_voxelize(const ChartOptions& options) {
    Chart chart;
    chart.notes = VoxelContenders::absent();
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:knot", "builtin:spheres", "builtin:tree", "builtin:needles"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb", engine_path}, scenes);
    }
    std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{128, 256, 512, 1024} : options.resolutions;
    std::sort(resolutions.begin(), resolutions.end());
    Runner runner(options, chart);
    double done = 0.0;
    for (const std::string& scene : scenes) {
        runner.measure(scene, resolutions, [&] {
            done += 1.0 / double(scenes.size() * resolutions.size());
            if (options.progress) options.progress(done);
        });
    }
    write_table(chart, options.folder, "voxelize");
    write_picture(chart, options.folder, voxelize_plot);
    return chart;
}

}  // namespace cairn::bench
