// Atty et al. 2005, sections 4.2 and 5.2: the error of soft shadow maps over the size of the occluder map,
// the size of the light, and where the occluder is; their time over polygons, map and light; and the
// formats of the sums (appendix A).
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <tuple>
#include <utility>

#include "bench/charts/chart.h"
#include "bench/plots/soft_shadow_plot.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "bench/trials/soft_shadow_study.h"

namespace cairn::bench {
namespace {

using renderer::ShadowFormat;
using renderer::ShadowMesh;
using renderer::ShadowPasses;
using renderer::SoftShadowMap;

/// Texels per side of the occluder map if its size does not vary.
constexpr int own_base = 128;
/// Points per side of the floor that are compared.
constexpr int most_points = 48;
/// Milliseconds after which a contender is not run again.
constexpr double contender_ms = 200.0;
/// Width of the light if it does not vary.
constexpr double base_light = 0.5;
/// The least gap to the light, as a share of the height that the occluder can rise.
constexpr double closest_gap = 0.02;

constexpr std::array own_sizes = {16, 24, 32, 48, 64, 96, 128, 160, 200, 256, 320, 512};
constexpr std::array own_format_sizes = {64, 128, 256, 512};
constexpr std::array light_widths = {0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
constexpr std::array laterals = {-1.5, -1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 1.0, 1.5};
constexpr std::array rises = {0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.87, 1.0 - closest_gap};
constexpr std::array polygon_counts = {2.0, 2e3, 16e3, 64e3, 128e3, 256e3, 512e3};

struct Plan {
    explicit Plan(const ChartOptions& options) : runs(options.runs) {
        sizes = options.resolutions;
        format_sizes = sizes;
        if (sizes.empty()) {
            sizes.assign(own_sizes.begin(), own_sizes.end());
            format_sizes.assign(own_format_sizes.begin(), own_format_sizes.end());
        }
        base = sizes.front();
        for (const int size : sizes)
            if (std::abs(size - own_base) < std::abs(base - own_base)) base = size;
        receiver_size = study_step * std::min(most_points, base);
    }
    std::vector<int> sizes, format_sizes;
    int base = own_base;
    int receiver_size = 0;
    int runs = 1;
};

/// A placement with its truth.
struct Case {
    Case(const ShadowOccluder& occluder, const ShadowPlacement& placement) : study(occluder, placement) {}
    StudyCase study;
    ShadowPoints points;
    std::vector<double> truth;
};

struct Contender {
    double parameter = 0.0;
    const Case* study_case = nullptr;
    int occluder_size = 0;
    ShadowPasses passes = ShadowPasses::two;
    ShadowFormat format = ShadowFormat::fp32;
    StudyWindow window = StudyWindow::fitted;
    const ShadowMesh* mesh = nullptr;  ///< null: the occluder's mesh
    SoftShadowErrors errors{};
    renderer::SoftShadowStatistics statistics{};
    std::vector<double> samples_ms{};
};

const char* name_of(ShadowFormat format) {
    switch (format) {
        case ShadowFormat::fp16:
            return "fp16";
        case ShadowFormat::fp16_batches:
            return "fp16-batches";
        case ShadowFormat::fp32:
            break;
    }
    return "fp32";
}

class OccluderStudies {
public:
    OccluderStudies(const ShadowOccluder& occluder, const Plan& plan, const ChartOptions& options,
                    Chart& chart)
        : occluder_(occluder),
          plan_(plan),
          options_(options),
          chart_(chart),
          tracer_(occluder.scene(), occluder.snapshot()),
          mesh_(occluder.scene(), occluder.snapshot()),
          base_(case_of({base_light, 0.0, occluder.default_gap()})) {}

    using Step = void (OccluderStudies::*)();
    static constexpr std::array<Step, 6> steps() {
        return {&OccluderStudies::over_sizes,    &OccluderStudies::over_lights,
                &OccluderStudies::over_laterals, &OccluderStudies::over_heights,
                &OccluderStudies::over_formats,  &OccluderStudies::over_polygons};
    }
    void run(Step step) { (this->*step)(); }

private:
    void over_sizes() {
        std::vector<Contender> contenders;
        for (const int size : plan_.sizes)
            add_passes(size, base_, size, contenders);
        measure("resolution", contenders);
    }

    void over_lights() {
        std::deque<Case> cases;
        std::vector<Contender> contenders;
        for (const double width : light_widths) {
            const Case& now = cases.emplace_back(case_of({width, 0.0, occluder_.default_gap()}));
            add_passes(width, now, plan_.base, contenders);
            for (const int size : {plan_.base / 2, plan_.base * 2})
                if (size > 0 && size <= renderer::max_shadow_map_size)
                    contenders.push_back({.parameter = width, .study_case = &now, .occluder_size = size});
        }
        measure("light-size", contenders);
    }

    void over_laterals() {
        std::deque<Case> cases;
        std::vector<Contender> contenders;
        for (const double lateral : laterals)
            add_passes(lateral, cases.emplace_back(case_of({base_light, lateral, occluder_.default_gap()})),
                       plan_.base, contenders);
        measure("lateral", contenders);
    }

    void over_heights() {
        std::deque<Case> cases;
        std::vector<Contender> contenders;
        for (const double rise : rises) {
            const double gap = rise * (study_light_height - occluder_.height());
            add_passes(rise, cases.emplace_back(case_of({base_light, 0.0, gap})), plan_.base, contenders);
        }
        measure("vertical", contenders);
    }

    void over_formats() {
        std::vector<Contender> contenders;
        for (const int size : plan_.format_sizes) {
            for (const ShadowFormat format :
                 {ShadowFormat::fp16, ShadowFormat::fp16_batches, ShadowFormat::fp32})
                contenders.push_back({.parameter = double(size),
                                      .study_case = &base_,
                                      .occluder_size = size,
                                      .passes = ShadowPasses::one,
                                      .format = format});
        }
        measure("format", contenders);
    }

    /// One shape, and so one shadow, of a rising number of triangles.
    void over_polygons() {
        const auto own = double(mesh_.triangle_count());
        std::deque<ShadowMesh> meshes;
        std::vector<Contender> contenders;
        int before = 0;
        for (const double count : polygon_counts) {
            const int parts = int(std::lround(std::sqrt(count / own)));
            if (parts <= before) continue;
            before = parts;
            const ShadowOccluder finer = occluder_.cut(parts);
            const ShadowMesh& mesh = meshes.emplace_back(finer.scene(), finer.snapshot());
            contenders.push_back({.parameter = double(mesh.triangle_count()),
                                  .study_case = &base_,
                                  .occluder_size = plan_.base,
                                  .mesh = &mesh});
        }
        if (contenders.empty())
            contenders.push_back({.parameter = own, .study_case = &base_, .occluder_size = plan_.base});
        measure("polygons", contenders);
    }

    /// Adds three contenders: one and two passes, and one pass with the window of Atty et al.
    static void add_passes(double parameter, const Case& now, int size, std::vector<Contender>& contenders) {
        for (const auto& [passes, window] : {std::pair(ShadowPasses::one, StudyWindow::fitted),
                                             {ShadowPasses::two, StudyWindow::fitted},
                                             {ShadowPasses::one, StudyWindow::shared}})
            contenders.push_back({.parameter = parameter,
                                  .study_case = &now,
                                  .occluder_size = size,
                                  .passes = passes,
                                  .window = window});
    }

    Case case_of(const ShadowPlacement& placement) {
        Case out(occluder_, placement);
        SoftShadowMap& map = map_of(plan_.base, ShadowPasses::one, ShadowFormat::fp32);
        map.compute(out.study.light(), out.study.frustum(StudyWindow::fitted), mesh_, out.study.floor());
        out.points = shadow_points(map);
        out.truth = truth_at(out.points, tracer_, out.study.light());
        return out;
    }

    SoftShadowMap& map_of(int size, ShadowPasses passes, ShadowFormat format) {
        const auto key = std::tuple(size, passes, format);
        auto found = maps_.find(key);
        if (found == maps_.end())
            found = maps_
                        .emplace(key,
                                 SoftShadowMap({size, plan_.receiver_size, passes, format}, options_.shaders))
                        .first;
        return found->second;
    }

    /// Measures the contenders in turn, so that ratios hold if the machine's speed drifts.
    void measure(const char* study, std::vector<Contender>& contenders) {
        for (int run = 0; run < plan_.runs; ++run) {
            for (Contender& contender : contenders) {
                double spent = 0.0;
                for (const double ms : contender.samples_ms)
                    spent += ms;
                if (run > 0 && spent > contender_ms) continue;
                SoftShadowMap& map = map_of(contender.occluder_size, contender.passes, contender.format);
                const StudyCase& study_case = contender.study_case->study;
                map.compute(study_case.light(), study_case.frustum(contender.window),
                            contender.mesh != nullptr ? *contender.mesh : mesh_, study_case.floor());
                contender.samples_ms.push_back(map.statistics().milliseconds);
                if (run > 0) continue;
                contender.statistics = map.statistics();
                contender.errors = soft_shadow_errors(map.visible(), contender.study_case->points,
                                                      contender.study_case->truth);
            }
        }
        for (const Contender& contender : contenders)
            add_row(study, contender);
    }

    void add_row(const char* study, const Contender& contender) const {
        const ShadowMesh& mesh = contender.mesh != nullptr ? *contender.mesh : mesh_;
        chart_.table.rows.push_back(on_this_machine(
            {occluder_.name(), std::string(study), contender.parameter, std::int64_t(contender.occluder_size),
             std::int64_t(plan_.receiver_size), std::int64_t(contender.passes == ShadowPasses::two ? 2 : 1),
             std::string(name_of(contender.format)),
             std::string(contender.window == StudyWindow::shared ? "shared" : "fitted"),
             contender.study_case->study.placement().light_width, std::int64_t(mesh.triangle_count()),
             contender.errors.mean, contender.errors.rmse, contender.errors.greatest,
             std::int64_t(contender.errors.shadowed), std::int64_t(contender.errors.wrong),
             median(contender.samples_ms), std::int64_t(contender.statistics.micro_patches),
             std::int64_t(contender.statistics.fragments)}));
    }

    const ShadowOccluder& occluder_;
    const Plan& plan_;
    const ChartOptions& options_;
    Chart& chart_;
    reference::ImageTracer tracer_;
    ShadowMesh mesh_;
    std::map<std::tuple<int, ShadowPasses, ShadowFormat>, SoftShadowMap> maps_;
    Case base_;
};

}  // namespace

Chart chart_soft_shadow_map(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"occluder", "study",         "parameter", "occluder_size", "receiver_size",
                           "passes",   "format",        "window",    "light_width",   "triangles",
                           "error",    "rmse",          "max_error", "points",        "wrong_points",
                           "ms",       "micro_patches", "fragments", "driver",        "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:square", "builtin:tree"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb"}, scenes);
        if (scenes.size() < 3) scenes.emplace_back("builtin:knot");
    }
    const Plan plan(options);
    double done = 0.0;
    for (const std::string& path : scenes) {
        const ShadowOccluder occluder(path);
        OccluderStudies studies(occluder, plan, options, chart);
        for (const auto step : OccluderStudies::steps()) {
            studies.run(step);
            done += 1.0 / double(scenes.size() * OccluderStudies::steps().size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "soft_shadow_map");
    write_picture(chart, options.folder, soft_shadow_plot);
    return chart;
}

}  // namespace cairn::bench
