// Every frame of an animation, moved and voxelized on the GPU, beside the time that Embree needs to rebuild
// its tree for the same frame: medians over the frames of all animations at 30 frames per second. The
// contenders take turns at each frame, so that ratios hold when the machine's speed drifts. `deform` is the
// time that each takes for the frame's vertices: the pose and a shader here, take_snapshot on the CPU for
// Embree.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/peers/rebuilt_tree.h"
#include "bench/trials/cost.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::bench {
namespace {

constexpr double frames_per_second = 30.0;
/// One of this many frames is compared with the exact voxels.
constexpr std::size_t checked_frames = 10;

struct Result {
    std::size_t triangles = 0;
    Costs deform, voxelize, ours, read_back;
    Costs snapshot, low, low_with_snapshot, medium, medium_with_snapshot;
    std::uint64_t missing = 0, extra = 0, checked = 0;
};

void measure_animation(const scenes::Scene& scene, int animation, int resolution,
                       voxelizer::Voxelizer& voxelizer, const gl::ShaderSource& shaders, Result& result) {
    const scenes::When when{0.0, animation, std::nullopt};
    const std::vector<double> times = scenes::frame_times(scene, when, frames_per_second);
    const voxelizer::Grid grid =
        voxelizer::grid_around(scenes::bounds_over_animation(scene, when, frames_per_second), resolution);
    const voxelizer::Region region = voxelizer::whole(grid);
    voxelizer::MovingSurface moving(scene, when, grid, {}, shaders);
    result.triangles = moving.triangle_count();
    const scenes::Snapshot first = scenes::take_snapshot(scene, when);
    RebuiltTree low(first, RTC_BUILD_QUALITY_LOW);
    RebuiltTree medium(first, RTC_BUILD_QUALITY_MEDIUM);
    voxelizer::BitGrid bits;
    // The driver compiles programs at their first use, which for some comes only after some frames.
    for (const double seconds : times)
        voxelizer.voxelize_into(moving.move_to(seconds), region, bits);
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        const double seconds = times[frame];
        const Cost deform = cost_of([&] {
            moving.move_to(seconds);
            glFinish();
        });
        const gl::Buffer* on_gpu = nullptr;
        const Cost voxelize = cost_of([&] { on_gpu = &voxelizer.voxelize_on_gpu(moving.surface(), region); });
        result.read_back.frames.push_back(
            cost_of([&] { on_gpu->read(0, bits.words.data(), bits.words.size() * 4); }));
        result.deform.frames.push_back(deform);
        result.voxelize.frames.push_back(voxelize);
        result.ours.frames.push_back(deform + voxelize);

        scenes::Snapshot snapshot;
        const Cost take = cost_of([&] {
            snapshot = scenes::take_snapshot(scene, {seconds, animation, std::nullopt});
        });
        result.snapshot.frames.push_back(take);
        for (RebuiltTree* tree : {&low, &medium}) {
            const Cost write = cost_of([&] { tree->write(snapshot); });
            const Cost build = cost_of([&] { tree->build(); });
            (tree == &low ? result.low : result.medium).frames.push_back(build);
            (tree == &low ? result.low_with_snapshot : result.medium_with_snapshot)
                .frames.push_back(take + write + build);
        }
        if (frame % checked_frames != 0) continue;
        const reference::Comparison comparison = reference::compare(
            bits, reference::exact_voxels(voxelizer::build_surface(scene, snapshot, grid), region));
        result.missing += comparison.missing;
        result.extra += comparison.extra;
        ++result.checked;
    }
}

std::vector<Cell> measure(const std::string& path, int resolution, voxelizer::Voxelizer& voxelizer,
                          const gl::ShaderSource& shaders) {
    const scenes::Scene scene = scenes::load(path);
    if (scene.animations.empty())
        throw Error(Fault::usage, path, "it has no animation", "choose an animated scene");
    Result r;
    for (int animation = 0; animation < int(scene.animations.size()); ++animation)
        measure_animation(scene, animation, resolution, voxelizer, shaders, r);
    return on_this_machine(
        {std::filesystem::path(path).filename().string(), std::int64_t(resolution), std::int64_t(r.triangles),
         std::int64_t(r.ours.frames.size()), r.deform.wall_ms(), r.voxelize.wall_ms(), r.ours.wall_ms(),
         r.read_back.wall_ms(), r.snapshot.wall_ms(), r.low.wall_ms(), r.low_with_snapshot.wall_ms(),
         r.medium.wall_ms(), r.medium_with_snapshot.wall_ms(), r.ours.processor_ms(), r.low.processor_ms(),
         r.medium.processor_ms(), std::int64_t(r.checked), std::int64_t(r.missing), std::int64_t(r.extra)});
}

}  // namespace

Chart chart_moving(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",
                           "resolution",
                           "triangles",
                           "frames",
                           "deform_ms",
                           "voxelize_ms",
                           "ours_ms",
                           "read_back_ms",
                           "cpu_deform_ms",
                           "embree_low_ms",
                           "embree_low_with_deform_ms",
                           "embree_medium_ms",
                           "embree_medium_with_deform_ms",
                           "ours_processor_ms",
                           "embree_low_processor_ms",
                           "embree_medium_processor_ms",
                           "checked_frames",
                           "missing",
                           "extra",
                           "driver",
                           "threads"};
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) add_real_scenes(chart, options, {"CesiumMan.glb", "Fox.glb"}, scenes);
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{128, 256} : options.resolutions;
    voxelizer::ConservativeVoxelizer voxelizer(options.shaders);
    double done = 0.0;
    for (const std::string& scene : scenes) {
        for (const int resolution : resolutions) {
            chart.table.rows.push_back(measure(scene, resolution, voxelizer, options.shaders));
            done += 1.0 / double(scenes.size() * resolutions.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "moving");
    return chart;
}

}  // namespace cairn::bench
