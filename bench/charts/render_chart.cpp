// Converged frames by time and by error against a picture of the triangles with 64 samples per pixel: over
// pixel error and the shape of the tree; at one shape, over what rays meet in voxels and over samples per
// pixel; and at one pixel error, over traversals and pool sizes.
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "bench/charts/chart.h"
#include "bench/plots/render_plot.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/picture_truth.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "reference/image.h"
#include "renderer/open_content.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 512;
constexpr double mebibyte = 1048576.0;
constexpr renderer::TreeOptions base{};
/// The base shape is measured with all of them, the other shapes with every second one.
constexpr std::array pixel_errors = {0.35, 0.5, 0.71, 1.0, 1.41, 2.0, 2.83, 4.0};
constexpr std::array<std::array<int, 2>, 7> shapes = {
    {{base.n, base.m}, {2, 16}, {2, 32}, {3, 27}, {4, 8}, {4, 32}, {8, 16}}};
/// What rays meet in voxels, beside what the base meets.
constexpr std::array geometries = {renderer::VoxelGeometry::voxel, renderer::VoxelGeometry::marks,
                                   renderer::VoxelGeometry::slabs};
constexpr std::array sample_counts = {2, 4, 8, 16};
constexpr std::array pools = {32U << 20U, 8U << 20U};

/// The parameters of a contender.
struct Setting {
    std::string varied;
    renderer::TreeOptions tree = {};
    renderer::RendererOptions options = {};
    int samples = 1;
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

const char* name_of(renderer::VoxelGeometry geometry) {
    switch (geometry) {
        case renderer::VoxelGeometry::voxel:
            return "voxel";
        case renderer::VoxelGeometry::marks:
            return "marks";
        case renderer::VoxelGeometry::slabs:
            return "slabs";
        case renderer::VoxelGeometry::both:
            break;
    }
    return "both";
}

/// Measures frames of all settings in turn.
class Contest {
public:
    Contest(const scenes::Scene& scene, const scenes::Snapshot& snapshot, const renderer::View& view,
            const ChartOptions& options)
        : scene_(scene), snapshot_(snapshot), view_(view), options_(options) {
        const renderer::RendererOptions usual = options.voxels.renderer();
        for (const auto& [n, m] : shapes) {
            const Setting setting{"shape", {.n = n, .m = m}, usual};
            const bool is_base = n == base.n && m == base.m;
            const auto ours = make(setting);
            for (std::size_t i = 0; i < pixel_errors.size(); ++i)
                if (is_base || i % 2 == 1) add(setting, ours, pixel_errors[i]);
        }
        for (const auto geometry : geometries) {
            Setting setting{"geometry", base, usual};
            setting.tree.geometry = geometry;
            const auto ours = make(setting);
            for (std::size_t i = 1; i < pixel_errors.size(); i += 2)
                add(setting, ours, pixel_errors[i]);
        }
        for (const int samples : sample_counts) {
            const Setting setting{"samples", base, usual, samples};
            const auto ours = make(setting);
            for (std::size_t i = 1; i < pixel_errors.size(); i += 2)
                add(setting, ours, pixel_errors[i]);
        }
        for (const auto traversal : {renderer::Traversal::restart, renderer::Traversal::stackless}) {
            Setting setting{"traversal", base, usual};
            setting.options.march.traversal = traversal;
            add(setting, make(setting), 1.0);
        }
        for (const std::size_t bytes : pools) {
            Setting setting{"pool", base, usual};
            setting.options.pools.brick_bytes = bytes;
            add(setting, make(setting), 1.0);
        }
        measure_in_turn(contenders_, options.runs, options.budget_ms);
    }

    void add_rows(const std::string& name, const reference::ShadedImage& truth, Table& table) const {
        for (std::size_t i = 0; i < contenders_.size(); ++i) {
            const FrameContender& contender = contenders_[i];
            const auto& [varied, tree, options, samples] = settings_[i];
            const PictureErrors errors = picture_errors(contender.image, truth);
            table.rows.push_back(on_this_machine(
                {name, varied, std::int64_t(contender.view.size.width), std::int64_t(tree.n),
                 std::int64_t(tree.m), std::string(name_of(options.march.traversal)),
                 std::string(name_of(tree.n == 3 ? renderer::VoxelGeometry::voxel : tree.geometry)),
                 double(options.pools.brick_bytes) / mebibyte, contender.view.detail.pixel_error,
                 std::int64_t(samples), median(contender.samples_ms), errors.rmse, errors.silhouette,
                 std::int64_t(contender.converged.bricks_used),
                 double(contender.converged.brick_bytes_resident) /
                     double(std::max<std::uint64_t>(contender.converged.bricks_resident, 1)),
                 std::int64_t(contender.converged.bricks_produced), truth.milliseconds}));
        }
    }

private:
    [[nodiscard]] std::shared_ptr<renderer::Renderer> make(const Setting& setting) const {
        return std::make_shared<renderer::Renderer>(
            renderer::surface_content(scene_, snapshot_, setting.tree, options_.shaders), setting.options,
            options_.shaders);
    }
    void add(Setting setting, std::shared_ptr<renderer::Renderer> ours, double pixel_error) {
        renderer::View view = view_;
        view.detail.pixel_error = pixel_error;
        view.samples = setting.samples;
        contenders_.emplace_back(std::move(ours), view);
        settings_.push_back(std::move(setting));
    }

    const scenes::Scene& scene_;
    const scenes::Snapshot& snapshot_;
    const renderer::View& view_;
    const ChartOptions& options_;
    std::vector<FrameContender> contenders_;
    std::vector<Setting> settings_;  // one per contender
};

}  // namespace

Chart chart_render(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {
        "scene",       "varied",          "size",     "n",      "m",      "traversal",  "geometry",
        "pool_mib",    "pixel_error",     "samples",  "ms",     "rmse",   "silhouette", "bricks_used",
        "brick_bytes", "bricks_produced", "truth_ms", "driver", "threads"};
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
        view.size = {size, size};
        view.camera = optics::framing_camera(snapshot.bounds, 1.0);
        const reference::ShadedImage truth = true_picture(scene, snapshot, view);
        Contest(scene, snapshot, view, options).add_rows(scene_name(path), truth, chart.table);
        done += 1.0 / double(scenes.size());
        if (options.progress) options.progress(done);
    }
    write_table(chart, options.folder, "render");
    write_picture(chart, options.folder, render_plot);
    return chart;
}

}  // namespace cairn::bench
