#include <array>

#include "base/error.h"
#include "base/output_file.h"
#include "bench/charts/chart.h"
#include "bench/plots/gnuplot.h"
#include "bench/plots/panel.h"

namespace cairn::bench {

std::span<const ChartKind> charts() {
    static constexpr std::array all = {
        ChartKind{"voxelize", "methods and their peers, by time and error", chart_voxelize},
        ChartKind{"embree",
                  "frames with shadows beside Embree's and NanoVDB's rays",
                  chart_embree,
                  {.tree = true, .traversal = true, .tile_queries = true}},
        ChartKind{"render",
                  "frames by time and error, over pixel error and tree",
                  chart_render,
                  {.tile_queries = true}},
        ChartKind{"resolution",
                  "the same view of 512^3 to 32768^3 voxels",
                  chart_resolution,
                  {.traversal = true, .tile_queries = true, .volume = true}},
        ChartKind{"structure",
                  "N and M, and a regular grid, on a hollow sphere",
                  chart_structure,
                  {.tile_queries = true, .volume = true}},
        ChartKind{
            "exploration",
            "frames at three distances, and on the way there",
            chart_exploration,
            {.tree = true, .traversal = true, .tile_queries = true, .volume = true, .frame_budget = true}},
        ChartKind{"moving-shadow", "animated scenes with soft shadows, by frame", chart_moving_shadow},
        ChartKind{"shadow",
                  "shadows by time and error, over every method",
                  chart_shadow,
                  {.traversal = true, .tile_queries = true}},
        ChartKind{"shadow-rays",
                  "shadow rays by their number and by resolution",
                  chart_shadow_rays,
                  {.traversal = true, .tile_queries = true}},
        ChartKind{"production",
                  "bricks that a first frame produces, and uses",
                  chart_production,
                  {.tree = true, .traversal = true, .tile_queries = true, .volume = true}},
        ChartKind{"soft-shadow-map", "error and time of soft shadow maps", chart_soft_shadow_map},
        ChartKind{"visibility",
                  "bricks produced: rays, occlusion queries, frustum",
                  chart_visibility,
                  {.tree = true, .traversal = true, .tile_queries = true}},
        ChartKind{"levels",
                  "levels of detail by time, memory and error",
                  chart_levels,
                  {.tree = true, .traversal = true, .tile_queries = true}},
        ChartKind{"moving", "animated scenes voxelized, beside Embree's rebuild", chart_moving},
        ChartKind{"region-deep", "a small region, with its index and without", chart_region_deep},
        ChartKind{"region-sizes", "a grid in regions of 1 to 64 MiB", chart_region_sizes},
        ChartKind{"check", "every scene against the exact voxels", chart_check},
    };
    return all;
}

void write_table(Chart& chart, const std::filesystem::path& folder, const std::string& name) {
    chart.table.name = name;
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed) throw Error(Fault::usage, folder.string(), failed.message(), "choose a folder to write to");
    const std::filesystem::path path = folder / (name + ".csv");
    const std::string text = csv_of(chart.table);
    OutputFile file(path);
    file.write(text.data(), text.size());
    file.commit();
    add_once(chart.files, path);
}

void write_picture(Chart& chart, const std::filesystem::path& folder,
                   std::string (*script_of)(const Table&, const std::filesystem::path&)) {
    const std::filesystem::path path = folder / (chart.table.name + ".png");
    const std::string failure = run_gnuplot(script_of(chart.table, path), folder);
    if (failure.empty()) {
        chart.files.push_back(path);
    } else {
        chart.notes.push_back("no picture: " + failure);
    }
}

}  // namespace cairn::bench
