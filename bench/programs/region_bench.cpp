// What a region costs, and how large regions should be.
//
//     region_bench OUT_FOLDER deep SCENE [SCENE ...]
//     region_bench OUT_FOLDER sizes SCENE RESOLUTION
//
// `deep`: one region of 64^3 voxels in scenes of any number of triangles, each at the level where the region
// holds about 2000 of them: the index is asked and the region marked anew each time. Writes region_deep.csv.
//
// `sizes`: a whole grid tile by tile, in regions of several sizes. Writes region_sizes.csv.
//
// Beside the wall's time stands the processor's, which holds better where the machine is shared.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sys/resource.h>

#include "base/error.h"
#include "base/output_file.h"
#include "gl/context.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/surface/triangle_index.h"

namespace {

using namespace cairn;

struct Times {
    double wall_ms = 0.0;
    double cpu_ms = 0.0;
};

double cpu_ms() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) { return double(t.tv_sec) * 1e3 + double(t.tv_usec) / 1e3; };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

template <typename Work>
Times measure(const Work& work) {
    const double cpu = cpu_ms();
    const auto start = std::chrono::steady_clock::now();
    work();
    const auto end = std::chrono::steady_clock::now();
    return {std::chrono::duration<double, std::milli>(end - start).count(), cpu_ms() - cpu};
}

voxelizer::Surface surface_of(const std::string& name, int resolution) {
    const scenes::Scene scene = scenes::load(name);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
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

/// Without its folders, which are those of one machine.
std::string file_name(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
}

std::string measure_deep(const std::string& name, voxelizer::Voxelizer& voxelizer) {
    constexpr int turns = 200;
    const voxelizer::Surface surface = surface_of(name, 512);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::TriangleIndex index(surface);
    const voxelizer::Region region = region_with(surface, index, 2000);
    const std::size_t inside = index.triangles_in(region).size();
    const std::uint64_t occupied = voxelizer.voxelize(on_gpu, region, index.triangles_in(region)).count();
    std::uint64_t sum = 0;
    const auto mark = [&] {
        for (int i = 0; i < turns; ++i)
            sum += voxelizer.voxelize(on_gpu, region, index.triangles_in(region)).words[0];
    };
    mark();
    const Times with_index = measure(mark);
    const Times asking = measure([&] {
        for (int i = 0; i < turns; ++i)
            sum += index.triangles_in(region).size();
    });
    const Times without = measure([&] {
        for (int i = 0; i < 20; ++i)
            sum += voxelizer.voxelize(on_gpu, region).words[0];
    });
    fmt::print(
        "{:<28} {:>8} triangles  {:>5} inside, level {:>2}, {:>6} voxels  region {:.3f} ms (processor "
        "{:.3f}), "
        "asking the index {:.3f} ms; without the index {:.2f} ms{}\n",
        file_name(name), surface.triangle_count, inside, region.level, occupied, with_index.wall_ms / turns,
        with_index.cpu_ms / turns, asking.cpu_ms / turns, without.wall_ms / 20, sum == 0 ? " " : "");
    return fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},\"{}\"\n", file_name(name),
                       surface.triangle_count, inside, region.level, occupied, with_index.wall_ms / turns,
                       with_index.cpu_ms / turns, asking.cpu_ms / turns, without.wall_ms / 20,
                       gl::driver_name());
}

std::string measure_sizes(const std::string& name, int resolution, voxelizer::Voxelizer& voxelizer) {
    const voxelizer::Surface surface = surface_of(name, resolution);
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    std::string csv;
    for (const std::size_t mib : {1, 2, 4, 8, 16, 32, 64}) {
        voxelizer::TriangleIndex index(surface);
        voxelizer::TileStatistics statistics;
        const Times times = measure([&] {
            statistics = voxelizer::voxelize_tiles(voxelizer, on_gpu, index, surface.grid,
                                                   [](voxelizer::VoxelTile&&) {}, {},
                                                   {.whole_bytes = 0, .region_bytes = mib << 20U});
        });
        fmt::print(
            "{} {:>5}  {:>3} MiB  {:>5} regions {:>9} triangles {:>9} voxels  {:>9.1f} ms in all, "
            "{:>9.1f} of it marking, {:>9.1f} of the processor\n",
            file_name(name), resolution, mib, statistics.regions, statistics.triangles, statistics.occupied,
            times.wall_ms, statistics.milliseconds, times.cpu_ms);
        csv += fmt::format("{},{},{},{},{},{},{:.2f},{:.2f},{:.2f},\"{}\"\n", file_name(name), resolution,
                           mib, statistics.regions, statistics.triangles, statistics.occupied, times.wall_ms,
                           statistics.milliseconds, times.cpu_ms, gl::driver_name());
    }
    return csv;
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    OutputFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace

int main(int argc, char** argv) try {
    const std::string_view what = argc > 3 ? argv[2] : "";
    if (what != "deep" && (what != "sizes" || argc != 5)) {
        fmt::print(stderr,
                   "usage: region_bench OUT_FOLDER deep SCENE [SCENE ...]\n"
                   "       region_bench OUT_FOLDER sizes SCENE RESOLUTION\n");
        return 2;
    }
    const auto context = gl::create_context();
    fmt::print("{}\n", gl::driver_name());
    voxelizer::ConservativeVoxelizer voxelizer;
    const std::filesystem::path folder = argv[1];
    if (what == "deep") {
        std::string csv =
            "scene,triangles,inside,level,occupied,region_ms,region_cpu_ms,index_cpu_ms,without_index_ms,"
            "driver\n";
        for (int i = 3; i < argc; ++i)
            csv += measure_deep(argv[i], voxelizer);
        write(folder / "region_deep.csv", csv);
    } else {
        write(folder / "region_sizes.csv",
              "scene,resolution,region_mib,regions,triangles,occupied,all_ms,marking_ms,cpu_ms,driver\n" +
                  measure_sizes(argv[3], std::atoi(argv[4]), voxelizer));
    }
    return 0;
} catch (const cairn::Error& error) {
    fmt::print(stderr, "error: {}\n  {}\n", error.what(), error.way_out());
    return 1;
}
