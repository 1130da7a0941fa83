// Converged frames by time and by error against a picture of the triangles with 64 samples a pixel: over
// pixel error and the shape of the tree, and at one of them over traversals and pool sizes.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "bench/charts/chart.h"
#include "bench/plots/render_plot.h"
#include "bench/trials/frames.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "reference/image.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 512;
constexpr int samples_a_side = 8;
constexpr double mebibyte = 1048576.0;
constexpr renderer::TreeOptions base{};
/// The base shape has them all; the others every second one.
constexpr std::array pixel_errors = {0.35, 0.5, 0.71, 1.0, 1.41, 2.0, 2.83, 4.0};
constexpr std::array<std::array<int, 2>, 7> shapes = {
    {{base.n, base.m}, {2, 16}, {2, 32}, {3, 27}, {4, 8}, {4, 32}, {8, 16}}};
constexpr std::array pools = {32U << 20U, 8U << 20U};

struct Setting {
    std::string varied;
    renderer::TreeOptions tree;
};

const char* name_of(renderer::Traversal traversal) {
    switch (traversal) {
        case renderer::Traversal::restart:
            return "restart";
        case renderer::Traversal::stackless:
            return "stackless";
        case renderer::Traversal::mini_stack:
            break;
    }
    return "mini-stack";
}

struct Errors {
    double rmse = 0.0;        ///< of sRGB in [0, 1]
    double silhouette = 0.0;  ///< wrongly covered area, as a share of what the scene covers
};

Errors errors_of(const optics::Image& ours, const reference::ShadedImage& truth) {
    double squares = 0.0;
    double wrong = 0.0;
    double covered = 0.0;
    for (std::size_t p = 0; p < truth.srgb.size(); ++p) {
        for (int channel = 0; channel < 3; ++channel) {
            const double apart =
                ours.rgba[4 * p + std::size_t(channel)] / 255.0 - double(truth.srgb[p][channel]);
            squares += apart * apart;
        }
        wrong += std::abs(ours.rgba[4 * p + 3] / 255.0 - double(truth.coverage[p]));
        covered += double(truth.coverage[p]);
    }
    return {std::sqrt(squares / (3.0 * double(truth.srgb.size()))), wrong / std::max(covered, 1.0)};
}

reference::ShadedImage truth_of(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                const renderer::View& view) {
    reference::Shading shading;
    shading.light_color = view.light.color;
    shading.ambient = view.light.ambient;
    shading.background = view.background;
    shading.shadows = view.shadow == renderer::Shadow::hard;
    return reference::ImageTracer(scene, snapshot)
        .shade(view.camera, view.light, shading, view.width, view.height, samples_a_side);
}

/// Frames in turn, over all that is varied.
class Contest {
public:
    Contest(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const renderer::View& view,
            const ChartOptions& options)
        : scene_(scene), snapshot_(snapshot), view_(view), options_(options) {
        for (const auto& [n, m] : shapes) {
            renderer::TreeOptions tree = base;
            tree.n = n;
            tree.m = m;
            const bool is_base = n == base.n && m == base.m;
            const auto ours = make(tree);
            for (std::size_t i = 0; i < pixel_errors.size(); ++i)
                if (is_base || i % 2 == 1) add({"shape", tree}, ours, pixel_errors[i]);
        }
        for (const auto traversal : {renderer::Traversal::restart, renderer::Traversal::stackless}) {
            renderer::TreeOptions tree = base;
            tree.traversal = traversal;
            add({"traversal", tree}, make(tree), 1.0);
        }
        for (const std::size_t bytes : pools) {
            renderer::TreeOptions tree = base;
            tree.brick_pool_bytes = bytes;
            add({"pool", tree}, make(tree), 1.0);
        }
        measure_in_turn(entrants_, options.runs, options.budget_ms);
    }

    void add_rows(const std::string& name, const reference::ShadedImage& truth, Table& table) const {
        for (std::size_t i = 0; i < entrants_.size(); ++i) {
            const Entrant& entrant = entrants_[i];
            const renderer::TreeOptions& tree = settings_[i].tree;
            const Errors errors = errors_of(entrant.image, truth);
            table.rows.push_back(on_this_machine(
                {name, settings_[i].varied, std::int64_t(entrant.view.width), std::int64_t(tree.n),
                 std::int64_t(tree.m), std::string(name_of(tree.traversal)),
                 double(tree.brick_pool_bytes) / mebibyte, entrant.view.pixel_error,
                 median(entrant.samples_ms), errors.rmse, errors.silhouette,
                 std::int64_t(entrant.converged.bricks_used), std::int64_t(entrant.converged.bricks_produced),
                 truth.milliseconds}));
        }
    }

private:
    [[nodiscard]] std::shared_ptr<renderer::Renderer> make(const renderer::TreeOptions& tree) const {
        return std::make_shared<renderer::Renderer>(scene_, snapshot_, tree, options_.shaders);
    }
    void add(Setting setting, std::shared_ptr<renderer::Renderer> ours, double pixel_error) {
        renderer::View view = view_;
        view.pixel_error = pixel_error;
        entrants_.emplace_back(std::move(ours), view);
        settings_.push_back(std::move(setting));
    }

    const scenes::Scene& scene_;
    const scenes::Snapshot& snapshot_;
    const renderer::View& view_;
    const ChartOptions& options_;
    std::vector<Entrant> entrants_;
    std::vector<Setting> settings_;  // of each
};

}  // namespace

Chart chart_render(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",           "varied",      "size",   "n",      "m",          "traversal",
                           "pool_mib",        "pixel_error", "ms",     "rmse",   "silhouette", "bricks_used",
                           "bricks_produced", "truth_ms",    "driver", "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb"}, scenes);
        if (scenes.empty()) scenes = {"builtin:knot"};
    }
    const int size = options.resolutions.empty() ? own_size : options.resolutions.front();
    double done = 0.0;
    for (const std::string& path : scenes) {
        const scenes::Scene scene = scenes::load(path);
        const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
        renderer::View view;
        view.width = view.height = size;
        view.camera = optics::framing_camera(snapshot.bounds, 1.0);
        const reference::ShadedImage truth = truth_of(scene, snapshot, view);
        Contest(scene, snapshot, view, options).add_rows(scene_name(path), truth, chart.table);
        done += 1.0 / double(scenes.size());
        if (options.progress) options.progress(done);
    }
    write_file(chart, options.folder, "render.csv", csv_of(chart.table));
    write_picture(chart, options.folder, "render.png", render_plot);
    return chart;
}

}  // namespace cairn::bench
