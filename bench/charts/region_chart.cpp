// The cost of a region, and how large regions should be.
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/trials/cost.h"
#include "bench/trials/real_scenes.h"
#include "gl/context.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::bench {
namespace {

constexpr int deep_resolution = 512;
constexpr std::size_t deep_triangles = 2000;
constexpr int deep_turns = 200;
constexpr int turns_without_index = 20;

voxelizer::Surface surface_of(const std::string& name, int resolution) {
    const scenes::Scene scene = scenes::load(name);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    if (snapshot.triangle_count == 0)
        throw Error(Fault::usage, name, "it has no triangles", "choose a scene with some");
    return voxelizer::build_surface(scene, snapshot, voxelizer::grid_around(snapshot.bounds, resolution));
}

/// The region of 64^3 voxels around one of the surface's vertices whose number of triangles is nearest to
/// `wanted`.
voxelizer::Region region_with(const voxelizer::Surface& surface, voxelizer::TriangleIndex& index,
                              std::size_t wanted) {
    voxelizer::Region best;
    std::size_t least = SIZE_MAX;
    const auto& positions = surface.chunks[0].positions;
    for (int level = 6; level <= 14; ++level) {
        for (std::size_t i = 0; i < 64; ++i) {
            const auto& p = positions[i * (positions.size() / 64)];
            const voxelizer::Region region{
                level, (glm::ivec3(p[0], p[1], p[2]) >> (LATTICE_BITS - level)) - 32, glm::ivec3(64)};
            const std::size_t count = index.triangles_in(region).size();
            const std::size_t off = count > wanted ? count - wanted : wanted - count;
            if (off >= least) continue;
            least = off;
            best = region;
        }
    }
    return best;
}

/// A file's name without its folders, which are those of one machine.
std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

/// Measures one region of 64^3 voxels, at the level where it holds about 2000 triangles. Each run queries the
/// index and marks the region again.
std::vector<Cell> measure_deep(const std::string& name, voxelizer::Voxelizer& voxelizer) {
    const voxelizer::Surface surface = surface_of(name, deep_resolution);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::TriangleIndex index(surface);
    const voxelizer::Region region = region_with(surface, index, deep_triangles);
    const std::uint64_t occupied = voxelizer.voxelize(on_gpu, region, index.triangles_in(region)).count();
    const auto mark = [&] {
        for (int i = 0; i < deep_turns; ++i)
            (void)voxelizer.voxelize(on_gpu, region, index.triangles_in(region));
    };
    mark();
    const Cost with_index = cost_of(mark);
    std::size_t sum = 0;
    const Cost asking = cost_of([&] {
        for (int i = 0; i < deep_turns; ++i)
            sum += index.triangles_in(region).size();
    });
    const Cost without = cost_of([&] {
        for (int i = 0; i < turns_without_index; ++i)
            (void)voxelizer.voxelize(on_gpu, region);
    });
    return {file_name(name),
            std::int64_t(surface.triangle_count),
            std::int64_t(sum / deep_turns),
            std::int64_t(region.level),
            std::int64_t(occupied),
            with_index.wall_ms / deep_turns,
            with_index.processor_ms / deep_turns,
            asking.processor_ms / deep_turns,
            without.wall_ms / turns_without_index,
            gl::driver_name()};
}

void measure_sizes(const std::string& name, int resolution, voxelizer::Voxelizer& voxelizer, Table& table) {
    const voxelizer::Surface surface = surface_of(name, resolution);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    for (const std::size_t mib : {1, 2, 4, 8, 16, 32, 64}) {
        voxelizer::TriangleIndex index(surface);
        voxelizer::TileStatistics statistics;
        const Cost cost = cost_of([&] {
            statistics = voxelizer::voxelize_tiles(voxelizer, on_gpu, index, surface.grid,
                                                   [](voxelizer::VoxelTile&&) {}, {},
                                                   {.whole_bytes = 0, .region_bytes = mib << 20U});
        });
        table.rows.push_back({file_name(name), std::int64_t(resolution), std::int64_t(mib),
                              std::int64_t(statistics.regions), std::int64_t(statistics.triangles),
                              std::int64_t(statistics.occupied), cost.wall_ms, statistics.milliseconds,
                              cost.processor_ms, gl::driver_name()});
    }
}

std::vector<std::string> scenes_of(Chart& chart, const ChartOptions& options) {
    std::vector<std::string> scenes = options.scenes;
    if (!scenes.empty()) return scenes;
    add_real_scenes(chart, options, {"stanford_bunny_69k.glb", "stanford_dragon_871k.glb"}, scenes);
    if (scenes.empty()) scenes = {"builtin:knot"};
    return scenes;
}

}  // namespace

Chart chart_region_deep(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {
        "scene",         "triangles",    "inside",           "level", "occupied", "region_ms",
        "region_cpu_ms", "index_cpu_ms", "without_index_ms", "driver"};
    voxelizer::ConservativeVoxelizer voxelizer(options.shaders);
    const std::vector<std::string> scenes = scenes_of(chart, options);
    for (const std::string& scene : scenes) {
        chart.table.rows.push_back(measure_deep(scene, voxelizer));
        if (options.progress) options.progress(double(chart.table.rows.size()) / double(scenes.size()));
    }
    write_table(chart, options.folder, "region_deep");
    return chart;
}

Chart chart_region_sizes(const ChartOptions& options) {
    Chart chart;
    chart.table.columns = {"scene",    "resolution", "region_mib", "regions", "triangles",
                           "occupied", "all_ms",     "marking_ms", "cpu_ms",  "driver"};
    voxelizer::ConservativeVoxelizer voxelizer(options.shaders);
    const std::vector<std::string> scenes = scenes_of(chart, options);
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{1024} : options.resolutions;
    double done = 0.0;
    for (const std::string& scene : scenes) {
        for (const int resolution : resolutions) {
            measure_sizes(scene, resolution, voxelizer, chart.table);
            done += 1.0 / double(scenes.size() * resolutions.size());
            if (options.progress) options.progress(done);
        }
    }
    write_table(chart, options.folder, "region_sizes");
    return chart;
}

}  // namespace cairn::bench
