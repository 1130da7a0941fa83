// Forest et al. 2009, section 3.1.2: shadow rays from rasterized fragments, by their number (Table 2) and by
// the resolution of the voxels (Table 3).
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bench/charts/chart.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/shadow_runs.h"
#include "bench/trials/shadow_scene.h"
#include "reference/shadow_truth.h"

namespace cairn::bench {
namespace {

constexpr int paper_width = 1024;  ///< pixels; the height is three quarters of it
constexpr int table_2_resolution = 128;
constexpr int truth_strata = 16;
/// If a number of rays took this many times ChartOptions::budget_ms, greater numbers are left out.
constexpr double slow_budgets = 2.5;

struct PaperRow {
    int number;
    /// Times of knot, tree and spheres on a GeForce 8800 GTX.
    std::array<double, 3> ms;
};
constexpr std::array<const char*, 3> paper_scenes = {"knot", "tree", "spheres"};
constexpr std::array<PaperRow, 7> table_2 = {{{1, {29, 46, 17}},
                                              {4, {104, 127, 54}},
                                              {8, {201, 230, 118}},
                                              {16, {390, 437, 236}},
                                              {32, {771, 844, 513}},
                                              {128, {3053, 3313, 1963}},
                                              {512, {12104, 13096, 7662}}}};
constexpr std::array<PaperRow, 7> table_3 = {{{8, {8, 24, 4}},
                                              {16, {12, 29, 6}},
                                              {32, {16, 34, 9}},
                                              {64, {22, 39, 13}},
                                              {128, {29, 46, 17}},
                                              {256, {56, 85, 30}},
                                              {512, {67, 103, 41}}}};

Cell paper_ms(std::span<const PaperRow> table, const std::string& scene, int number) {
    const auto column = std::find(paper_scenes.begin(), paper_scenes.end(), scene);
    const auto row =
        std::find_if(table.begin(), table.end(), [&](const PaperRow& r) { return r.number == number; });
    if (column == paper_scenes.end() || row == table.end()) return {};
    return row->ms[std::size_t(column - paper_scenes.begin())];
}

/// A method to follow rays through voxels of one resolution.
struct Traversal {
    const char* name;
    renderer::ShadowMethod method;
    renderer::ColumnMask mask = renderer::ColumnMask::adaptive;
};
constexpr std::array traversals = {
    Traversal{"n3-tree", renderer::ShadowMethod::voxel},
    Traversal{"pyramid", renderer::ShadowMethod::pyramid},
    Traversal{"pyramid-mip-mask", renderer::ShadowMethod::pyramid, renderer::ColumnMask::mip_level}};

using Frames = std::shared_ptr<ShadowFrames>;
Frames frames_of(const Traversal& traversal, const ShadowScene& scene, int resolution,
                 const ChartOptions& options) {
    return std::make_shared<ShadowFrames>(
        traversal.method, scene,
        renderer::ShadowOptions{.tree = tree_of(resolution),
                                .renderer = options.voxels.renderer(),
                                .pyramid = {.resolution = resolution, .mask = traversal.mask}},
        options.shaders);
}

/// The parameters of a contender. @p table is 2 or 3.
struct Setting {
    const Traversal* traversal;
    int table, rays, resolution;
};
struct Measurement {
    Setting setting;
    RepeatedRuns runs;
};

class RayTables {
public:
    RayTables(Chart& chart, const ChartOptions& options)
        : chart_(chart),
          options_(options),
          width_(options.width.value_or(paper_width)),
          height_(std::max(width_ * 3 / 4, 1)) {
        chart_.table.columns = {"scene",          "triangles",     "table",    "method",
                                "rays",           "resolution",    "ms",       "first_ms",
                                "paper_ms",       "unshadowed_ms", "ms_a_ray", "hard_disagreement",
                                "mean_in_shadow", "rmse",          "pixels",   "driver",
                                "threads"};
    }

    void measure_scene(const std::string& path, const std::function<void(double)>& done) {
        const ShadowScene scene(path, false);
        std::vector<Measurement> all;
        for (const Traversal& traversal : traversals) {
            add_table_2(scene, traversal, all);
            for (const int resolution : resolutions_of(table_3))
                add(scene, {&traversal, 3, 1, resolution}, frames_of(traversal, scene, resolution, options_),
                    all);
        }
        done(0.4);
        for (Measurement& one : all)
            one.runs.sweep(options_.runs, options_.budget_ms);
        done(0.8);
        add_rows(scene, all);
    }

private:
    [[nodiscard]] std::vector<int> resolutions_of(std::span<const PaperRow> table) const {
        if (!options_.resolutions.empty()) return options_.resolutions;
        std::vector<int> all;
        for (const PaperRow& row : table)
            all.push_back(row.number);
        return all;
    }

    /// Adds a contender. @param setting  with 0 rays: a frame without shadows.
    void add(const ShadowScene& scene, const Setting& setting, const Frames& frames,
             std::vector<Measurement>& all) const {
        renderer::View view = scene.view(width_, height_, std::max(setting.rays, 1));
        view.detail.pixel_error = always_finest;
        if (setting.rays == 0) view.shadow.kind = renderer::ShadowQuality::Kind::none;
        RepeatedRuns runs([frames, view] { return frames->run(view); });
        runs.sweep((options_.runs + 1) / 2, 0.5 * options_.budget_ms);
        all.push_back({setting, std::move(runs)});
    }

    void add_table_2(const ShadowScene& scene, const Traversal& traversal, std::vector<Measurement>& all) {
        const int resolution =
            options_.resolutions.empty() ? table_2_resolution : options_.resolutions.back();
        const Frames frames = frames_of(traversal, scene, resolution, options_);
        add(scene, {&traversal, 2, 0, resolution}, frames, all);
        for (const PaperRow& row : table_2) {
            add(scene, {&traversal, 2, row.number, resolution}, frames, all);
            const double ms = all.back().runs.ms();
            if (ms <= slow_budgets * options_.budget_ms || row.number == table_2.back().number) continue;
            chart_.notes.push_back(
                fmt::format("{}: more than {} rays are left out, which took {:.1f} s with {}", scene.name(),
                            row.number, ms / 1000.0, traversal.name));
            return;
        }
    }

    void add_rows(const ShadowScene& scene, const std::vector<Measurement>& all) {
        const renderer::View view = scene.view(width_, height_, 1);
        const reference::ImageTracer tracer(scene.scene(), scene.all());
        const reference::ShadowQuestion question{
            scene.scene(), scene.all(), scene.caster_nodes(), view.camera, view.light, width_, height_};
        const reference::ShadowReceivers receivers = shadow_receivers(tracer, question);
        const std::vector<float> hard = hard_shares(receivers);
        reference::AreaLightOptions sampling;
        sampling.exact_strata = truth_strata;
        sampling.rays = reference::ImageTracer::Rays::packets;
        const std::vector<float> soft =
            soft_shares(tracer, question, receivers, sampling, options_.truth_cache).shares;
        std::map<std::pair<std::string, int>, double> by_rays;
        for (const Measurement& one : all)
            if (one.setting.table == 2)
                by_rays[{one.setting.traversal->name, one.setting.rays}] = one.runs.ms();
        for (const Measurement& one : all) {
            const Setting& setting = one.setting;
            if (setting.rays == 0) continue;
            const double unshadowed_ms = by_rays.at({setting.traversal->name, 0});
            const bool is_soft = setting.rays > 1;
            const reference::ShadowError error =
                reference::shadow_error(one.runs.shares(), is_soft ? soft : hard);
            const double ms = one.runs.ms();
            const bool by_number = setting.table == 2;
            chart_.table.rows.push_back(
                on_this_machine({scene.name(), std::int64_t(scene.all().triangle_count),
                                 std::int64_t(setting.table), std::string(setting.traversal->name),
                                 std::int64_t(setting.rays), std::int64_t(setting.resolution), ms,
                                 one.runs.first_ms() ? Cell(*one.runs.first_ms()) : Cell{},
                                 is_paper(setting) ? paper_ms(by_number ? table_2 : table_3, scene.name(),
                                                              by_number ? setting.rays : setting.resolution)
                                                   : Cell{},
                                 unshadowed_ms, (ms - unshadowed_ms) / setting.rays,
                                 is_soft ? Cell{} : Cell(error.disagreement()),
                                 is_soft ? Cell(error.mean_in_shadow()) : Cell{},
                                 is_soft ? Cell(error.rmse()) : Cell{}, std::int64_t(error.pixels)}));
        }
        for (const Traversal& traversal : traversals)
            tell_linearity(scene.name(), traversal.name, by_rays);
    }

    static bool is_paper(const Setting& setting) {
        return setting.table == 3 || setting.resolution == table_2_resolution;
    }

    void tell_linearity(const std::string& scene, const char* method,
                        const std::map<std::pair<std::string, int>, double>& by_rays) {
        const auto few = by_rays.find({method, 4});
        const auto many = by_rays.find({method, 128});
        if (few == by_rays.end() || many == by_rays.end()) return;
        const double unshadowed_ms = by_rays.at({method, 0});
        const double growth = many->second / few->second / 32.0;
        const double of_rays = (many->second - unshadowed_ms) / (few->second - unshadowed_ms) / 32.0;
        chart_.notes.push_back(fmt::format(
            "{}, {}: 128 rays take {:.3f} times 32 times the time of 4; {:.3f} without the rest of "
            "the frame",
            scene, method, growth, of_rays));
    }

    Chart& chart_;
    const ChartOptions& options_;
    int width_, height_;  ///< size of the picture in pixels
};

}  // namespace

Chart chart_shadow_rays(const ChartOptions& options) {
    Chart chart;
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty())
        for (const char* scene : paper_scenes)
            scenes.push_back(fmt::format("builtin:{}", scene));
    RayTables tables(chart, options);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        tables.measure_scene(scenes[i], [&](double part) {
            if (options.progress) options.progress((double(i) + part) / double(scenes.size()));
        });
        if (options.progress) options.progress(double(i + 1) / double(scenes.size()));
    }
    write_table(chart, options.folder, "shadow_rays");
    return chart;
}

}  // namespace cairn::bench
