#include <filesystem>
#include <thread>

#include "app/options/parse.h"
#include "app/options/voxel_rows.h"
#include "app/terminal/driver.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/terminal/terminal.h"
#include "app/verbs/verbs.h"
#include "base/error.h"
#include "bench/charts/chart.h"

namespace cairn::app {
namespace {

constexpr int max_runs = 1000;
constexpr int max_bench_resolution = 32768;

struct Options {
    std::string chart;
    bench::ChartOptions what;
    DriverOptions driver;
    ReportOptions report;
};

const bench::ChartKind& chart_named(const std::string& name) {
    Names<const bench::ChartKind*> names;
    for (const bench::ChartKind& kind : bench::charts())
        names.emplace_back(kind.name, &kind);
    if (const auto kind = find_named(name, names)) return **kind;
    throw Error(Fault::usage, "bench", "there is no chart \"" + name + "\"",
                "choose one of: " + joined(names, ", ", ", "));
}

std::vector<int> sizes_of(const std::string& text) {
    std::vector<int> sizes;
    for (const double size : parse_numbers("--resolutions", text, 1, 16)) {
        if (size < 1 || size > max_bench_resolution || size != int(size)) {
            throw Error(Fault::usage, "--resolutions",
                        "\"" + text + "\" is not a list of whole numbers from 1 to " +
                            std::to_string(max_bench_resolution));
        }
        sizes.push_back(int(size));
    }
    return sizes;
}

/// An option of voxels, and the member that says whether a chart takes it.
struct VoxelRow {
    OptionRow<bench::VoxelOptions> row;
    bool bench::VoxelOptionsTaken::*taken;
};
std::vector<VoxelRow> voxel_rows() {
    using Voxels = bench::VoxelOptions;
    using Taken = bench::VoxelOptionsTaken;
    return {
        {tree_n_row<Voxels>([](auto& voxels) -> auto& { return voxels.tree_n; }), &Taken::tree},
        {brick_m_row<Voxels>([](auto& voxels) -> auto& { return voxels.brick_m; }), &Taken::tree},
        {max_resolution_row<Voxels>([](auto& voxels) -> auto& { return voxels.max_resolution; }),
         &Taken::tree},
        {traversal_row<Voxels>([](auto& voxels) -> auto& { return voxels.traversal; }), &Taken::traversal},
        {tile_queries_row<Voxels>([](auto& voxels) -> auto& { return voxels.tile_queries; }),
         &Taken::tile_queries},
        {steps_row<Voxels>([](auto& voxels) -> auto& { return voxels.steps_per_voxel; }), &Taken::volume},
        {gradient_row<Voxels>([](auto& voxels) -> auto& { return voxels.gradient_threshold; }),
         &Taken::volume},
        {budget_row<Voxels>([](auto& voxels) -> auto& { return voxels.frame_budget_ms; }),
         &Taken::frame_budget},
    };
}

/// @throws Error (Fault::usage) if an option was given that the chart does not take.
void check_voxel_options(const bench::ChartKind& kind, const bench::VoxelOptions& voxels) {
    for (const VoxelRow& option : voxel_rows()) {
        if (!option.row.print(voxels) || kind.takes.*option.taken) continue;
        throw Error(Fault::usage, option.row.long_name(),
                    "the chart \"" + std::string(kind.name) + "\" varies it itself, or has no use for it",
                    "leave it out");
    }
}

/// The options that were given, with their names as the keys.
Json json_of_voxel_options(const bench::VoxelOptions& voxels) {
    Json given = Json::object();
    for (const VoxelRow& option : voxel_rows())
        if (const auto value = option.row.print(voxels)) given[option.row.long_name().substr(2)] = *value;
    return given;
}

void add_options(CLI::App& verb, Options& options) {
    std::string charts;
    for (const bench::ChartKind& kind : bench::charts())
        charts += "\n" + std::string(kind.name) + ": " + std::string(kind.description);
    verb.add_option("CHART", options.chart, "what to measure:" + charts)->required()->type_name("");
    verb.add_option("-o,--output", options.what.folder,
                    "the folder for the CSV and the picture (default: this one)")
        ->type_name("DIR");
    add_parsed_option(verb, "--scenes", "DIR", "the folder of the real scenes (stanford_bunny_69k.glb)",
                      [&options](const std::string& text) {
                          if (!std::filesystem::is_directory(text))
                              throw Error(Fault::usage, "--scenes", "\"" + text + "\" is not a folder");
                          options.what.scene_folder = text;
                      });
    verb.add_option("--scene", options.what.scenes,
                    "a scene to measure instead of the chart's own; may be\nrepeated")
        ->type_name("SCENE")
        ->allow_extra_args(false);
    add_parsed_option(verb, "--resolutions", "N,...", "voxels per side, or pixels (default: the chart's own)",
                      [&options](const std::string& text) { options.what.resolutions = sizes_of(text); });
    add_parsed_option(
        verb, "--runs", "N", "runs per median; fewer if they are slow (default: 7)",
        [&options](const std::string& text) { options.what.runs = parse_int("--runs", text, 1, max_runs); });
    verb.add_option_function<std::string>(
            "--truth-cache", [&options](const std::string& text) { options.what.truth_cache = text; },
            "a folder that keeps Embree's shares of soft lights, for\nthe next run")
        ->type_name("DIR");
    OptionTable<bench::VoxelOptions> voxels;
    for (const VoxelRow& option : voxel_rows())
        voxels.push_back(option.row);
    add_table(verb, voxels, options.what.voxels);
    add_driver_options(verb, options.driver);
    add_report_options(verb, options.report);
}

Json json_of_cell(const bench::Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return *whole;
    return std::get<double>(cell);
}

Json json_of_table(const bench::Table& table) {
    Json rows = Json::array();
    for (const std::vector<bench::Cell>& row : table.rows) {
        Json object = Json::object();
        for (std::size_t i = 0; i < row.size(); ++i) {
            // The driver is the same for all rows, and reported once.
            const std::string& column = table.columns[i];
            if (column == "driver" || column == "threads" || row[i].index() == 0) continue;
            object[column == "ms" ? "milliseconds" : column] = json_of_cell(row[i]);
        }
        rows.push_back(std::move(object));
    }
    return rows;
}

ExitCode run(const Options& options) {
    const bench::ChartKind& kind = chart_named(options.chart);
    check_voxel_options(kind, options.what.voxels);
    Report report(options.report);
    const Driver driver(options.driver);
    bench::Chart chart;
    {
        Progress progress("measuring", options.report.quiet);
        bench::ChartOptions what = options.what;
        what.shaders = options.driver.shaders;
        what.progress = [&progress](double done) { progress.set(done); };
        chart = kind.draw(what);
    }
    driver.check();
    if (!options.report.quiet) {
        for (const std::string& note : chart.notes)
            warn(note);
    }
    report.add("measurements", json_of_table(chart.table));
    if (Json given = json_of_voxel_options(options.what.voxels); !given.empty())
        report.add("voxel_options", std::move(given));
    Json files = Json::array();
    for (const std::filesystem::path& file : chart.files)
        files.push_back(file.string());
    report.add("output", std::move(files));
    report.add("threads", std::thread::hardware_concurrency());
    report.add("driver", driver.name());
    report.add("backend", driver.backend());
    report.finish();
    return chart.differs ? ExitCode::differs : ExitCode::done;
}

}  // namespace

void add_bench(CLI::App& command, Work& chosen) {
    add_verb<Options>(command, chosen, "bench", bench_description, add_options, run);
}

}  // namespace cairn::app
