// Levels of detail: their error against Embree with 64 samples per pixel, beside their cost. Scenes are shown
// white, from their framing camera and from twice as far. Frames are converged. Times are processor times,
// which vary less than wall-clock times on a machine that is shared.
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/charts/chart.h"
#include "bench/trials/cost.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/picture_truth.h"
#include "bench/trials/real_scenes.h"
#include "renderer/open_content.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::bench {
namespace {

constexpr int own_size = 512;
constexpr std::array distances = {1.0, 2.0};
constexpr std::array pixel_errors = {0.5, 1.0, 2.0, 4.0};
constexpr std::size_t pool_bytes = std::size_t(512) << 20U;
constexpr double kibibyte = 1024.0;
/// Errors are in steps of an 8-bit picture.
constexpr double steps = 255.0;

/// A level of detail, and whether bricks hold mips.
struct Method {
    const char* name;
    bool mips;
    renderer::LevelOfDetail::Kind level_of_detail;
};
constexpr std::array methods = {Method{"nearest", false, renderer::LevelOfDetail::Kind::nearest},
                                Method{"nearest+mips", true, renderer::LevelOfDetail::Kind::nearest},
                                Method{"blended", true, renderer::LevelOfDetail::Kind::blended}};

/// Removes colours and textures, except those of alpha masks, which need their textures.
void whiten(scenes::Scene& scene) {
    for (scenes::Material& material : scene.materials) {
        material.base_color = glm::vec4(1.0F, 1.0F, 1.0F, material.base_color.a);
        if (material.alpha_mode != scenes::AlphaMode::mask) material.texture = -1;
    }
    for (scenes::Mesh& mesh : scene.meshes) {
        for (scenes::Primitive& primitive : mesh.primitives)
            primitive.colors.clear();
    }
}

class Levels {
public:
    Levels(const std::string& path, const ChartOptions& options)
        : name_(scene_name(path)), options_(options), scene_(scenes::load(path)) {
        whiten(scene_);
        snapshot_ = scenes::take_snapshot(scene_);
    }

    void measure(int size, double distance, Table& table) const {
        renderer::View view;
        view.size = {size, size};
        view.camera = optics::framing_camera(snapshot_.bounds, 1.0);
        view.camera.eye = view.camera.target + distance * (view.camera.eye - view.camera.target);
        const reference::ShadedImage truth = true_picture(scene_, snapshot_, view);
        for (const Method& method : methods) {
            for (const double pixel_error : pixel_errors) {
                view.detail.pixel_error = pixel_error;
                table.rows.push_back(row_of(view, method, distance, truth));
            }
        }
    }

private:
    [[nodiscard]] std::vector<Cell> row_of(renderer::View view, const Method& method, double distance,
                                           const reference::ShadedImage& truth) const {
        view.detail.kind = method.level_of_detail;
        const renderer::TreeOptions tree = options_.voxels.tree({.mips = method.mips});
        renderer::Renderer ours(renderer::surface_content(scene_, snapshot_, tree, options_.shaders),
                                options_.voxels.renderer({.pools = {.brick_bytes = pool_bytes}}),
                                options_.shaders);
        renderer::Frame frame;
        const Cost first = cost_of([&] { frame = ours.render(view); });
        const auto& [image, statistics] = frame;
        double least_ms = std::numeric_limits<double>::infinity();
        for (int run = 0; run < options_.runs; ++run)
            least_ms = std::min(least_ms, cost_of([&] { (void)marched_frame(ours, view); }).processor_ms);
        const double slot_kib =
            double(statistics.brick_bytes_resident) / double(statistics.bricks_resident) / kibibyte;
        return on_this_machine(
            {name_, fmt::format("{}x{}", view.size.width, view.size.height), distance,
             std::string(method.name), view.detail.pixel_error, steps * picture_errors(image, truth).rmse,
             std::int64_t(statistics.bricks_produced), slot_kib,
             slot_kib * double(statistics.bricks_produced) / kibibyte, first.processor_ms, least_ms});
    }

    std::string name_;
    const ChartOptions& options_;
    scenes::Scene scene_;
    scenes::Snapshot snapshot_;  ///< points into the scene
};

}  // namespace

Chart chart_levels(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",  "size",        "distance", "level_of_detail", "pixel_error",  "rmse",
                           "bricks", "kib_a_brick", "mib",      "first_cpu_ms",    "frame_cpu_ms", "driver",
                           "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:knot", "builtin:tree"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb"}, scenes);
    }
    const std::vector<int> sizes =
        options.resolutions.empty() ? std::vector<int>{own_size} : options.resolutions;
    const double views = double(scenes.size() * sizes.size() * distances.size());
    double done = 0.0;
    for (const std::string& scene : scenes) {
        const Levels levels(scene, options);
        for (const int size : sizes) {
            for (const double distance : distances) {
                levels.measure(size, distance, chart.table);
                done += 1.0 / views;
                if (options.progress) options.progress(done);
            }
        }
    }
    write_table(chart, options.folder, "levels");
    return chart;
}

}  // namespace cairn::bench
