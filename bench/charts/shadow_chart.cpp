// Shadows of a hard and of a soft light by time and by error against Embree, over every method and setting.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "bench/charts/chart.h"
#include "bench/plots/shadow_plot.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/shadow_contenders.h"
#include "bench/trials/shadow_scene.h"

namespace cairn::bench {
namespace {

constexpr int own_width = 384;
// Multiples of ChartOptions::budget_ms: the time of a contender in the first sweep, its time in both sweeps,
// and the time after which the rest of its line is left out.
constexpr double first_sweep_budgets = 0.25;
constexpr double both_sweeps_budgets = 0.5;
constexpr double slow_budgets = 7.0;
constexpr double goal_rmse = 0.03;

struct Measurement {
    ShadowContender contender;
    RepeatedRuns runs;
};

std::vector<Measurement> measure(const ShadowCase& shadow_case, Chart& chart,
                                 const std::function<void(double)>& done) {
    const ChartOptions& options = shadow_case.options;
    std::vector<Measurement> all;
    std::map<std::pair<std::string, std::string>, double> slow;  // seconds; 0 once there is a note
    const std::vector<ShadowContender> contenders = shadow_contenders(shadow_case);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const std::pair line(contenders[i].method, contenders[i].setting.varied);
        if (const auto known = slow.find(line); known != slow.end()) {
            if (known->second > 0.0)
                chart.notes.push_back(
                    fmt::format("{}, {}: the rest of \"{}\" is left out after {:.1f} s for a setting",
                                shadow_case.scene.name(), line.first, line.second, known->second));
            known->second = 0.0;
            continue;
        }
        RepeatedRuns& runs =
            all.emplace_back(Measurement{contenders[i], RepeatedRuns(contenders[i].run)}).runs;
        runs.sweep((options.runs + 1) / 2, first_sweep_budgets * options.budget_ms);
        if (runs.spent_ms() > slow_budgets * options.budget_ms) slow[line] = runs.spent_ms() / 1000.0;
        done(0.6 * double(i + 1) / double(contenders.size()));
    }
    for (Measurement& measured : all)
        measured.runs.sweep(options.runs, both_sweeps_budgets * options.budget_ms);
    done(1.0);
    return all;
}

/// The pixels that a row of the table is about, with their true shares; -1 for all other pixels.
struct PixelTruth {
    std::string receivers;
    std::vector<float> truth;
    bool is_ground = false;
};

struct Result {
    const Measurement* measured = nullptr;
    reference::ShadowError error;
};

/// The time that Embree takes to come down to an error, in milliseconds. Between two numbers of samples the
/// error is a power of time. 0 if it takes more samples than were measured.
double embree_ms(const std::vector<Result>& results, double rmse) {
    std::map<std::string, std::vector<std::pair<double, double>>> lines;  // (rmse, ms) by method
    for (const Result& result : results)
        if (result.measured->contender.setting.samples)
            lines[result.measured->contender.method].emplace_back(result.error.rmse(),
                                                                  result.measured->runs.ms());
    double least = 0.0;
    const auto offer = [&](double ms) { least = least > 0.0 ? std::min(least, ms) : ms; };
    for (const auto& [method, line] : lines) {
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (line[i].first <= rmse) offer(line[i].second);
            if (i == 0 || line[i].first > rmse || line[i - 1].first <= rmse) continue;
            const double share = std::log(line[i - 1].first / rmse) /
                                 std::log(line[i - 1].first / std::max(line[i].first, 1e-9));
            offer(std::exp(std::lerp(std::log(line[i - 1].second), std::log(line[i].second), share)));
        }
    }
    return least;
}

Cell cell(const std::optional<int>& value) {
    return value ? Cell(std::int64_t(*value)) : Cell{};
}
Cell cell(const std::optional<double>& value) {
    return value ? Cell(*value) : Cell{};
}

class ShadowTable {
public:
    ShadowTable(Chart& chart, const ChartOptions& options) : chart_(chart), options_(options) {
        chart_.table.columns = {"scene",
                                "light",
                                "receivers",
                                "method",
                                "varied",
                                "rays",
                                "resolution",
                                "map_size",
                                "kernel",
                                "samples",
                                "passes",
                                "format",
                                "ms",
                                "first_ms",
                                "pixels",
                                "hard_disagreement",
                                "mean_in_shadow",
                                "rmse",
                                "max_error",
                                "embree_ms",
                                "embree_over",
                                "goal",
                                "truth_error",
                                "driver",
                                "threads"};
        ;
    }

    void measure_scene(const std::string& path, const std::function<void(double)>& done) {
        const ShadowScene scene(path);
        const int width = options_.resolutions.empty() ? own_width : options_.resolutions.front();
        const int height = std::max(width * 3 / 4, 1);
        const renderer::View view = scene.view(width, height, 1);
        const reference::ImageTracer tracer(scene.scene(), scene.all());
        const scenes::NodeSelection everything(scene.scene().nodes.size(), true);
        const auto question = [&](const scenes::NodeSelection& receivers) {
            return reference::ShadowQuestion{scene.scene(), scene.all(), receivers, view.camera,
                                             view.light,    width,       height};
        };
        const reference::ShadowReceivers all = shadow_receivers(tracer, question(everything));
        const reference::ShadowReceivers ground = shadow_receivers(tracer, question(scene.ground_nodes()));
        const std::vector<float> on_ground = hard_shares(ground);
        KeptVoxels voxels;
        for (const bool is_soft : {false, true}) {
            std::vector<float> truth = hard_shares(all);
            double truth_error = 0.0;
            if (is_soft) {
                reference::AreaLightOptions sampling;
                sampling.rays = reference::ImageTracer::Rays::packets;
                reference::SoftShares soft =
                    soft_shares(tracer, question(everything), all, sampling, options_.truth_cache);
                truth = std::move(soft.shares);
                truth_error = soft.greatest_standard_error;
            }
            std::vector<float> ground_truth = truth;
            for (std::size_t i = 0; i < truth.size(); ++i)
                if (on_ground[i] < 0.0F) ground_truth[i] = -1.0F;
            const ShadowCase shadow_case{scene, width, height, is_soft, tracer, all, voxels, options_};
            const double before = is_soft ? 0.4 : 0.0;
            const std::vector<Measurement> measured = measure(
                shadow_case, chart_, [&](double part) { done(before + part * (is_soft ? 0.6 : 0.4)); });
            add_rows(shadow_case, {"ground", std::move(ground_truth), true}, measured, truth_error);
            add_rows(shadow_case, {"all", std::move(truth), false}, measured, truth_error);
        }
    }

private:
    void add_rows(const ShadowCase& shadow_case, const PixelTruth& judged,
                  const std::vector<Measurement>& measured, double truth_error) {
        std::vector<Result> results;
        for (const Measurement& one : measured)
            if (judged.is_ground || !one.contender.ground_only)
                results.push_back({&one, reference::shadow_error(one.runs.shares(), judged.truth)});
        const std::array<const Result*, 2> fastest = {fastest_within_goal(results, true),
                                                      fastest_within_goal(results, false)};
        if (shadow_case.is_soft) tell_goal(shadow_case, judged, fastest);
        for (const Result& result : results) {
            const ShadowSetting& setting = result.measured->contender.setting;
            const reference::ShadowError& error = result.error;
            const double theirs = shadow_case.is_soft ? embree_ms(results, error.rmse()) : 0.0;
            const bool is_fastest =
                shadow_case.is_soft && std::find(fastest.begin(), fastest.end(), &result) != fastest.end();
            const double ms = result.measured->runs.ms();
            chart_.table.rows.push_back(on_this_machine({shadow_case.scene.name(),
                                                         std::string(shadow_case.is_soft ? "soft" : "hard"),
                                                         judged.receivers,
                                                         result.measured->contender.method,
                                                         setting.varied,
                                                         cell(setting.rays),
                                                         cell(setting.resolution),
                                                         cell(setting.map_size),
                                                         cell(setting.kernel),
                                                         cell(setting.samples),
                                                         setting.passes,
                                                         setting.format,
                                                         ms,
                                                         cell(result.measured->runs.first_ms()),
                                                         std::int64_t(error.pixels),
                                                         error.disagreement(),
                                                         error.mean_in_shadow(),
                                                         error.rmse(),
                                                         error.greatest,
                                                         theirs > 0.0 ? Cell(theirs) : Cell{},
                                                         theirs > 0.0 ? Cell(theirs / ms) : Cell{},
                                                         std::string(is_fastest ? "fastest" : ""),
                                                         truth_error}));
        }
    }

    /// The fastest result within the goal, or null. @param ours  of our methods; false: of Embree's.
    static const Result* fastest_within_goal(const std::vector<Result>& results, bool ours) {
        const Result* best = nullptr;
        for (const Result& result : results) {
            const ShadowContender& contender = result.measured->contender;
            if (result.error.rmse() > goal_rmse) continue;
            if (ours ? !contender.is_ours : !contender.setting.samples) continue;
            if (best == nullptr || result.measured->runs.ms() < best->measured->runs.ms()) best = &result;
        }
        return best;
    }

    static std::string described(const Result& result) {
        const ShadowSetting& setting = result.measured->contender.setting;
        std::string text = result.measured->contender.method;
        if (setting.rays) text += fmt::format(", {} rays", *setting.rays);
        if (setting.resolution) text += fmt::format(" at {}^3", *setting.resolution);
        if (setting.map_size) text += fmt::format(", {0}x{0}", *setting.map_size);
        if (setting.samples) text += fmt::format(", {} samples", *setting.samples);
        return fmt::format("{}: {:.1f} ms (RMSE {:.3f})", text, result.measured->runs.ms(),
                           result.error.rmse());
    }

    void tell_goal(const ShadowCase& shadow_case, const PixelTruth& judged,
                   const std::array<const Result*, 2>& fastest) {
        const std::string where = fmt::format("{}, {}, RMSE {} at most: ", shadow_case.scene.name(),
                                              judged.is_ground ? "ground" : "all", goal_rmse);
        if (fastest[0] == nullptr || fastest[1] == nullptr) {
            chart_.notes.push_back(where +
                                   (fastest[0] == nullptr ? "no setting of ours" : "no count of Embree's") +
                                   " comes to it");
            return;
        }
        chart_.notes.push_back(
            where + fmt::format("{}; {}; ours is {:.2f} times as fast", described(*fastest[0]),
                                described(*fastest[1]),
                                fastest[1]->measured->runs.ms() / fastest[0]->measured->runs.ms()));
    }

    Chart& chart_;
    const ChartOptions& options_;
};

}  // namespace

Chart chart_shadow(const ChartOptions& options) {
    Chart chart;
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:knot", "builtin:tree"};
        add_real_scenes(chart, options, {"dutch_ship/dutch_ship_medium_1k.gltf"}, scenes);
    }
    ShadowTable table(chart, options);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        table.measure_scene(scenes[i], [&](double part) {
            if (options.progress) options.progress((double(i) + part) / double(scenes.size()));
        });
    }
    write_table(chart, options.folder, "shadow");
    write_picture(chart, options.folder, shadow_plot);
    return chart;
}

}  // namespace cairn::bench
