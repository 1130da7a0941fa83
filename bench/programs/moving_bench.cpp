// Every frame of an animation, moved and voxelized on the GPU, beside the time that Embree needs to rebuild
// its tree for the same frame.
//
//     moving_bench OUT_FOLDER [SCENE ...]
//
// Without scenes: CesiumMan and Fox of the folder of test scenes. Prints a table and writes
// OUT_FOLDER/moving.csv: medians over the frames of all animations at 30 a second. The contenders take turns
// at each frame, so that ratios hold when the machine's speed drifts; processor time is given too, for
// machines that are shared. `deform` counts what each needs to have the frame's vertices: the pose and a
// shader here, take_snapshot on the CPU for Embree.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "gl/context.h"
#include "reference/embree.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "scenes/transform.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/moving_surface.h"

namespace {

using namespace cairn;

constexpr double frames_per_second = 30.0;

/// Milliseconds by the wall clock, and of the processor in all threads.
struct Cost {
    double wall = 0.0;
    double processor = 0.0;
    Cost operator+(const Cost& other) const { return {wall + other.wall, processor + other.processor}; }
};

template <typename Work>
Cost cost_of(const Work& work) {
    const std::clock_t processor = std::clock();
    const auto start = std::chrono::steady_clock::now();
    work();
    const auto stop = std::chrono::steady_clock::now();
    return {std::chrono::duration<double, std::milli>(stop - start).count(),
            1000.0 * double(std::clock() - processor) / CLOCKS_PER_SEC};
}

/// An Embree scene whose triangles stay and whose vertices are written anew for each frame.
class RebuiltTree {
public:
    RebuiltTree(const scenes::Snapshot& snapshot, RTCBuildQuality quality)
        : device_(rtcNewDevice(nullptr)), tree_(rtcNewScene(device_.get())) {
        rtcSetSceneBuildQuality(tree_.get(), quality);
        if (quality == RTC_BUILD_QUALITY_LOW) rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_DYNAMIC);
        for (const scenes::Item& item : snapshot.items) {
            if (item.primitive->topology == scenes::Topology::triangles && !item.primitive->indices.empty())
                add(item, quality);
        }
        if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
            throw Error(Fault::memory, "Embree", "it cannot hold the triangles");
    }

    void write(const scenes::Snapshot& snapshot) {
        std::size_t next = 0;
        for (const scenes::Item& item : snapshot.items) {
            if (item.primitive->topology != scenes::Topology::triangles || item.primitive->indices.empty())
                continue;
            const Geometry& geometry = geometries_[next++];
            for (std::size_t i = 0; i < item.positions.size(); ++i) {
                const glm::vec3 world(scenes::transform_point(item.world_from_mesh, item.positions[i]));
                for (int axis = 0; axis < 3; ++axis)
                    geometry.vertices[3 * i + std::size_t(axis)] = world[axis];
            }
            rtcUpdateGeometryBuffer(geometry.owner.get(), RTC_BUFFER_TYPE_VERTEX, 0);
        }
    }

    void build() const {
        for (const Geometry& geometry : geometries_)
            rtcCommitGeometry(geometry.owner.get());
        rtcCommitScene(tree_.get());
    }

private:
    struct Geometry {
        reference::EmbreeGeometry owner;
        float* vertices;
    };

    void add(const scenes::Item& item, RTCBuildQuality quality) {
        reference::EmbreeGeometry owner(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* const vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(owner.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), item.positions.size()));
        auto* const indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(owner.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), item.primitive->element_count()));
        if (vertices == nullptr || indices == nullptr)
            throw Error(Fault::memory, "Embree", "it cannot hold the triangles");
        std::copy(item.primitive->indices.begin(), item.primitive->indices.end(), indices);
        rtcSetGeometryBuildQuality(owner.get(), quality);
        rtcAttachGeometry(tree_.get(), owner.get());
        geometries_.push_back({std::move(owner), vertices});
    }

    reference::EmbreeDevice device_;
    reference::EmbreeScene tree_;
    std::vector<Geometry> geometries_;
};

/// What one contender took, frame by frame.
struct Series {
    std::vector<Cost> frames;
    [[nodiscard]] double wall() const { return median(&Cost::wall); }
    [[nodiscard]] double processor() const { return median(&Cost::processor); }

private:
    [[nodiscard]] double median(double Cost::*part) const {
        std::vector<double> values;
        for (const Cost& cost : frames)
            values.push_back(cost.*part);
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    }
};

struct Result {
    std::size_t triangles = 0;
    Series deform, voxelize, ours, read_back;
    Series snapshot, low, low_with_snapshot, medium, medium_with_snapshot;
    std::uint64_t missing = 0, extra = 0, checked = 0;
};

void measure_animation(const scenes::Scene& scene, int animation, int resolution,
                       voxelizer::Voxelizer& voxelizer, Result& result) {
    const scenes::When when{0.0, animation, std::nullopt};
    const std::vector<double> times = scenes::frame_times(scene, when, frames_per_second);
    const voxelizer::Grid grid =
        voxelizer::grid_around(scenes::bounds_over_animation(scene, when, frames_per_second), resolution);
    const voxelizer::Region region = voxelizer::whole(grid);
    voxelizer::MovingSurface moving(scene, when, grid);
    result.triangles = moving.triangle_count();
    const scenes::Snapshot first = scenes::take_snapshot(scene, when);
    RebuiltTree low(first, RTC_BUILD_QUALITY_LOW);
    RebuiltTree medium(first, RTC_BUILD_QUALITY_MEDIUM);
    voxelizer::BitGrid bits;
    // Programs are compiled by the driver at their first use, which some come to only after some frames.
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
        if (frame % 10 != 0) continue;
        const reference::Comparison comparison = reference::compare(
            bits, reference::exact_voxels(voxelizer::build_surface(scene, snapshot, grid), region));
        result.missing += comparison.missing;
        result.extra += comparison.extra;
        ++result.checked;
    }
}

std::string measure(const std::string& path, int resolution, voxelizer::Voxelizer& voxelizer) {
    const std::string name = std::filesystem::path(path).filename().string();
    const scenes::Scene scene = scenes::load(path);
    if (scene.animations.empty())
        throw Error(Fault::usage, path, "it has no animation", "choose an animated scene");
    Result r;
    for (int animation = 0; animation < int(scene.animations.size()); ++animation)
        measure_animation(scene, animation, resolution, voxelizer, r);
    fmt::print(
        "{:<14} {:>4}  {} triangles, {} frames  deform {:.2f} + voxelize {:.2f} ms (read back {:.2f})  "
        "Embree "
        "low {:.2f}, medium {:.2f} ms, with deformation {:.2f}, {:.2f}  processor: ours {:.2f}, low {:.2f}, "
        "medium {:.2f}  {} missing, {} extra in {} frames\n",
        name, resolution, r.triangles, r.ours.frames.size(), r.deform.wall(), r.voxelize.wall(),
        r.read_back.wall(), r.low.wall(), r.medium.wall(), r.low_with_snapshot.wall(),
        r.medium_with_snapshot.wall(), r.ours.processor(), r.low.processor(), r.medium.processor(), r.missing,
        r.extra, r.checked);
    return fmt::format(
        "{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{"
        "},"
        "{},\"{}\",{}\n",
        name, resolution, r.triangles, r.ours.frames.size(), r.deform.wall(), r.voxelize.wall(),
        r.ours.wall(), r.read_back.wall(), r.snapshot.wall(), r.low.wall(), r.low_with_snapshot.wall(),
        r.medium.wall(), r.medium_with_snapshot.wall(), r.ours.processor(), r.low.processor(),
        r.medium.processor(), r.checked, r.missing, r.extra, gl::driver_name(),
        std::thread::hardware_concurrency());
}

}  // namespace

int main(int argc, char** argv) try {
    std::vector<std::string> scenes(argv + std::min(argc, 2), argv + argc);
#ifdef CAIRN_SCENE_DATA
    if (scenes.empty()) scenes = {CAIRN_SCENE_DATA "/gltf/CesiumMan.glb", CAIRN_SCENE_DATA "/gltf/Fox.glb"};
#endif
    if (argc < 2 || scenes.empty()) {
        fmt::print(stderr, "usage: moving_bench OUT_FOLDER [SCENE ...]\n");
        return 2;
    }
    const auto context = gl::create_context();
    fmt::print("{}\n", gl::driver_name());
    voxelizer::ConservativeVoxelizer voxelizer;
    std::string csv =
        "scene,resolution,triangles,frames,deform_ms,voxelize_ms,ours_ms,read_back_ms,cpu_deform_ms,"
        "embree_low_ms,embree_low_with_deform_ms,embree_medium_ms,embree_medium_with_deform_ms,"
        "ours_processor_ms,embree_low_processor_ms,embree_medium_processor_ms,checked_frames,missing,extra,"
        "driver,threads\n";
    for (const std::string& scene : scenes) {
        for (const int resolution : {128, 256})
            csv += measure(scene, resolution, voxelizer);
    }
    std::filesystem::create_directories(argv[1]);
    OutputFile file(std::filesystem::path(argv[1]) / "moving.csv");
    file.write(csv.data(), csv.size());
    file.commit();
    return 0;
} catch (const cairn::Error& error) {
    fmt::print(stderr, "error: {}\n  {}\n", error.what(), error.way_out());
    return 1;
}
