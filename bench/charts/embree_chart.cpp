// Converged frames with hard shadows beside rays on the CPU: Embree's on the same triangles, one at a time
// and in packets, and NanoVDB's on the same voxels. All are measured in turn, so that ratios hold when the
// machine's speed drifts.
#include <cmath>
#include <functional>
#include <memory>
#include <thread>

#include "bench/charts/chart.h"
#include "bench/trials/frame_contenders.h"
#include "bench/trials/real_scenes.h"
#include "bench/trials/samples.h"
#include "gl/context.h"
#include "reference/image.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/surface/surface.h"
#ifdef CAIRN_BENCH_NANOVDB
#include "bench/peers/nanovdb_march.h"
#endif

namespace cairn::bench {
namespace {

/// The tree for the comparison on the same voxels: one level of bricks under the root.
constexpr int voxel_resolution = 512;
constexpr renderer::TreeOptions voxel_tree{.n = 4, .m = 32, .max_resolution = voxel_resolution};
constexpr double always_finest = 1e-3;  // pixel error below the size of the finest voxels

struct Contender {
    std::string name;
    std::function<double()> run;  ///< runs once and returns milliseconds
    std::vector<double> samples;
};

#ifdef CAIRN_BENCH_NANOVDB
GridView in_voxels(const renderer::View& view, const voxelizer::Grid& grid) {
    GridView out;
    out.width = view.size.width;
    out.height = view.size.height;
    out.eye = (view.camera.eye - grid.origin) / grid.voxel_size;
    out.forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(out.forward, view.camera.up));
    const double half_height = std::tan(0.5 * view.camera.yfov);
    out.right = right * (half_height * view.size.width / view.size.height);
    out.up = glm::cross(right, out.forward) * half_height;
    out.towards_light = view.light.towards;
    return out;
}

std::unique_ptr<NanoVdbMarch> nanovdb_of(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                         const voxelizer::Grid& grid, const gl::ShaderSource& shaders) {
    const voxelizer::Surface surface = voxelizer::build_surface(scene, snapshot, grid);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::ConservativeVoxelizer voxelizer(shaders);
    return std::make_unique<NanoVdbMarch>(voxelizer.voxelize(on_gpu, voxelizer::whole(grid)));
}
#endif

class Peers {
public:
    Peers(const ChartOptions& options, Chart& chart) : options_(options), chart_(chart) {
        chart_.table.columns = {"scene",   "triangles", "width",    "height", "method", "ms",
                                "ours_ms", "ours_over", "first_ms", "bricks", "driver", "threads"};
    }

    void measure(const std::string& path, const glm::ivec2& size) {
        const scenes::Scene scene = scenes::load(path);
        const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
        renderer::View view;
        view.size = {size.x, size.y};
        view.camera = optics::framing_camera(snapshot.bounds, double(size.x) / size.y);
        scene_ = path;
        triangles_ = std::int64_t(snapshot.triangle_count);
        beside_embree(scene, snapshot, view);
#ifdef CAIRN_BENCH_NANOVDB
        beside_nanovdb(scene, snapshot, view);
#endif
    }

private:
    void beside_embree(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                       const renderer::View& view) {
        const VoxelOptions& voxels = options_.voxels;
        renderer::Renderer ours(renderer::surface_content(scene, snapshot, voxels.tree(), options_.shaders),
                                voxels.renderer(), options_.shaders);
        const reference::ImageTracer embree(scene, snapshot);
        using Rays = reference::ImageTracer::Rays;
        const auto trace = [&](Rays rays) {
            return embree.trace(view.camera, view.light, view.size.width, view.size.height, 0, rays)
                .milliseconds;
        };
        compare(ours, view,
                {{"embree-single", [&] { return trace(Rays::single); }, {}},
                 {"embree-packets", [&] { return trace(Rays::packets); }, {}}});
    }

#ifdef CAIRN_BENCH_NANOVDB
    void beside_nanovdb(const scenes::Scene& scene, const scenes::Snapshot& snapshot, renderer::View view) {
        view.detail.pixel_error = always_finest;
        renderer::Renderer ours(renderer::surface_content(scene, snapshot, voxel_tree, options_.shaders),
                                options_.voxels.renderer(), options_.shaders);
        const voxelizer::Grid grid = voxelizer::grid_around(snapshot.bounds, voxel_resolution);
        const std::unique_ptr<NanoVdbMarch> peer = nanovdb_of(scene, snapshot, grid, options_.shaders);
        const GridView rays = in_voxels(view, grid);
        compare(ours, view, {{"nanovdb-512", [&] { return peer->march(rays).milliseconds; }, {}}});
    }
#endif

    void compare(renderer::Renderer& ours, const renderer::View& view, std::vector<Contender> peers) {
        const renderer::FrameStatistics first = marched_frame(ours, view).statistics;
        const auto bricks = std::int64_t(first.bricks_produced);
        std::vector<double> ours_ms;
        std::vector<std::vector<double>> ratios(peers.size());
        for (int i = 0; i < options_.runs; ++i) {
            ours_ms.push_back(marched_frame(ours, view).statistics.milliseconds);
            for (std::size_t p = 0; p < peers.size(); ++p) {
                peers[p].samples.push_back(peers[p].run());
                ratios[p].push_back(ours_ms.back() / peers[p].samples.back());
            }
        }
        for (std::size_t p = 0; p < peers.size(); ++p) {
            chart_.table.rows.push_back({scene_name(scene_), triangles_, std::int64_t(view.size.width),
                                         std::int64_t(view.size.height), peers[p].name,
                                         median(peers[p].samples), median(ours_ms), median(ratios[p]),
                                         first.milliseconds, bricks, gl::driver_name(),
                                         std::int64_t(std::thread::hardware_concurrency())});
        }
    }

    const ChartOptions& options_;
    Chart& chart_;
    std::string scene_;
    std::int64_t triangles_ = 0;
};

}  // namespace

Chart chart_embree(const ChartOptions& options) {
    Chart chart;
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        scenes = {"builtin:tree", "builtin:knot"};
        add_real_scenes(chart, options, {"stanford_bunny_69k.glb", "stanford_dragon_871k.glb", engine_path},
                        scenes);
    }
    std::vector<glm::ivec2> sizes;
    for (const int side : options.resolutions)
        sizes.emplace_back(side);
    if (sizes.empty()) sizes = {{512, 512}, {1024, 768}};
#ifndef CAIRN_BENCH_NANOVDB
    chart.notes.push_back("NanoVDB is left out: its headers were not found when this was built");
#endif
    Peers peers(options, chart);
    double done = 0.0;
    for (const std::string& scene : scenes) {
        for (const glm::ivec2& size : sizes) {
            peers.measure(scene, size);
            done += 1.0 / double(scenes.size() * sizes.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "embree");
    return chart;
}

}  // namespace cairn::bench
