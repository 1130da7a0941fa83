// The conservative method against the exact reference, bit by bit, over all scenes: at rest and, if a scene
// has an animation, in the middle of its first one.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "bench/charts/chart.h"
#include "bench/trials/cost.h"
#include "gl/context.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "voxelizer/files/voxel_tiles.h"
#include "voxelizer/methods/conservative_voxelizer.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::bench {
namespace {

struct CheckedScene {
    std::string path;
    std::string name;  ///< name in the table
};

/// The scenes of the options; if there are none, the built-in ones and every glTF file of the scene folder.
std::vector<CheckedScene> checked_scenes(Chart& chart, const ChartOptions& options) {
    std::vector<CheckedScene> scenes;
    for (const std::string& scene : options.scenes)
        scenes.push_back({scene, scene});
    if (!scenes.empty()) return scenes;
    for (const scenes::Builtin& builtin : scenes::builtins()) {
        const std::string scene = fmt::format("builtin:{}", builtin.name);
        scenes.push_back({scene, scene});
    }
    if (!options.scene_folder) {
        chart.notes.emplace_back("built-in scenes alone: no --scenes folder was given");
        return scenes;
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*options.scene_folder)) {
        const std::filesystem::path ending = entry.path().extension();
        if (ending == ".gltf" || ending == ".glb") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    for (const std::filesystem::path& file : files)
        scenes.push_back({file.string(), std::filesystem::relative(file, *options.scene_folder).string()});
    return scenes;
}

/// Compares tile by tile, as tiles arrive. Tiles that do not arrive must be empty in the truth too.
reference::Comparison compared(voxelizer::Voxelizer& voxelizer, const voxelizer::Surface& surface,
                               std::uint64_t& occupied) {
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(surface);
    voxelizer::TriangleIndex index(surface);
    voxelizer::BitGrid ours(surface.grid.resolution);
    occupied =
        voxelizer::voxelize_tiles(voxelizer, on_gpu, index, surface.grid, [&](voxelizer::VoxelTile&& tile) {
            put_tile(tile, ours);
        }).occupied;
    return reference::compare(ours, reference::exact_voxels(surface, voxelizer::whole(surface.grid)));
}

class Checks {
public:
    Checks(const ChartOptions& options, Chart& chart) : chart_(chart), voxelizer_(options.shaders) {
        chart_.table.columns = {
            "scene", "animation_seconds", "resolution", "triangles", "occupied", "missing",
            "extra", "outcome",           "seconds",    "driver"};
    }

    void check(const CheckedScene& checked, const std::vector<int>& resolutions) {
        const scenes::Scene scene = scenes::load(checked.path);
        std::vector<std::optional<double>> moments = {std::nullopt};
        if (!scene.animations.empty()) moments.emplace_back(0.5 * scene.animations[0].duration);
        for (const std::optional<double>& moment : moments) {
            for (const int resolution : resolutions)
                check(checked.name, scene, moment, resolution);
        }
    }

    [[nodiscard]] std::string summary() const {
        return fmt::format("{} checks, {} not the same", chart_.table.rows.size(), not_same_);
    }

private:
    void check(const std::string& name, const scenes::Scene& scene, const std::optional<double>& moment,
               int resolution) {
        std::vector<Cell> row{name, moment ? Cell(*moment) : Cell{}, std::int64_t(resolution)};
        std::string outcome;
        const Cost cost = cost_of([&] { outcome = outcome_of(name, scene, moment, resolution, row); });
        row.insert(row.end(), {outcome, cost.wall_ms / 1000.0, gl::driver_name()});
        chart_.table.rows.push_back(std::move(row));
        if (outcome == "same") return;
        ++not_same_;
        chart_.differs = true;
    }

    /// Adds the figures to the row. @return "same", "differs" or "failed"
    const char* outcome_of(const std::string& name, const scenes::Scene& scene,
                           const std::optional<double>& moment, int resolution, std::vector<Cell>& row) {
        try {
            const scenes::Snapshot snapshot = moment
                                                  ? scenes::take_snapshot(scene, {*moment, 0, std::nullopt})
                                                  : scenes::take_snapshot(scene);
            const voxelizer::Surface surface = voxelizer::build_surface(
                scene, snapshot, voxelizer::grid_around(snapshot.bounds, resolution));
            std::uint64_t occupied = 0;
            const reference::Comparison comparison = compared(voxelizer_, surface, occupied);
            row.insert(row.end(), {std::int64_t(surface.triangle_count), std::int64_t(occupied),
                                   std::int64_t(comparison.missing), std::int64_t(comparison.extra)});
            return comparison.missing == 0 && comparison.extra == 0 ? "same" : "differs";
        } catch (const Error& error) {
            chart_.notes.push_back(fmt::format("{} at {}: {}", name, resolution, error.what()));
            row.insert(row.end(), 4, Cell{});
            return "failed";
        }
    }

    Chart& chart_;
    voxelizer::ConservativeVoxelizer voxelizer_;
    int not_same_ = 0;
};

}  // namespace

Chart chart_check(const ChartOptions& options) {
    Chart chart;
    const std::vector<CheckedScene> scenes = checked_scenes(chart, options);
    const std::vector<int> resolutions =
        options.resolutions.empty() ? std::vector<int>{64, 128, 256, 512} : options.resolutions;
    Checks checks(options, chart);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        checks.check(scenes[i], resolutions);
        // The chart takes long: if it is stopped, the rows so far are kept.
        write_table(chart, options.folder, "check");
        if (options.progress) options.progress(double(i + 1) / double(scenes.size()));
    }
    if (chart.differs) chart.notes.push_back(checks.summary());
    return chart;
}

}  // namespace cairn::bench
