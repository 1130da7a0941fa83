#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/terminal/measure.h"
#include "app/terminal/progress.h"
#include "app/terminal/report.h"
#include "app/terminal/terminal.h"
#include "app/verbs/verbs.h"
#include "app/verbs/voxelization.h"
#include "base/error.h"
#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/files/write_npy.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

struct Options {
    VoxelizationOptions voxelization;
    std::optional<fs::path> output;
    std::optional<fs::path> doubtful;
    std::optional<voxelizer::SolidRule> solid;
    bool plain = false;
};

void add_options(CLI::App& verb, Options& options) {
    add_output_option(
        verb, options.output, voxelizer::voxel_file_endings(),
        fmt::format("the file for the voxels; its ending is the format:\n{};\n.npy holds uint8 of shape "
                    "(X, Y, Z), a[x, y, z],\n1 = occupied",
                    fmt::join(voxelizer::voxel_file_endings(), ", ")));
    add_parsed_option(
        verb, "--fill", "NAME",
        "surface: only voxels that the surface touches (default);\n"
        "solid, winding: also what the surface winds around;\n"
        "parity: also what is inside by the number of crossings;\n"
        "outside: also all that the outside cannot reach",
        [&options](const std::string& name) { options.solid = named("--fill", name, fill_names()); });
    add_file_option(
        verb, "--doubtful", options.doubtful, voxelizer::voxel_file_endings(),
        "a file for doubtful voxels of a solid: empty, though enclosed\nby what makes no cavity; or "
        "filled, though reached");
    verb.add_flag("--plain", options.plain, "no colours and no normals in the file: much faster");
    add_voxelization_options(verb, options.voxelization);
}

std::string in_bytes(double bytes) {
    if (bytes >= 0x1p30) return fmt::format("{:.1f} GiB", bytes / 0x1p30);
    return bytes >= 0x1p20 ? fmt::format("{:.1f} MiB", bytes / 0x1p20)
                           : fmt::format("{:.1f} KiB", bytes / 0x1p10);
}

/// Checks before any work that there is room for a .npy file, which holds every voxel, empty or not.
/// @throws Error (Fault::memory) if there is not.
void check_room(const fs::path& path, const voxelizer::Grid& grid) {
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (is_device(path) || ending != ".npy") return;
    const glm::dvec3 voxels(grid.resolution);
    const double needed = voxels.x * voxels.y * voxels.z;
    std::error_code unknown;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const fs::space_info room = fs::space(folder, unknown);
    if (unknown || needed <= double(room.available)) return;
    throw Error(
        Fault::memory, path.string(),
        fmt::format("a byte for each of {} x {} x {} voxels takes {}, and {} are free", grid.resolution.x,
                    grid.resolution.y, grid.resolution.z, in_bytes(needed), in_bytes(double(room.available))),
        "choose a format that leaves out what is empty (.vdb), or fewer voxels");
}

std::unique_ptr<voxelizer::VoxelWriter> make_writer(const fs::path& path, const voxelizer::Grid& grid) {
    check_room(path, grid);
    // A device needs no ending; it gets a .npy file.
    if (is_device(path) && !path.has_extension()) return voxelizer::make_npy_writer(path, grid);
    return voxelizer::make_voxel_writer(path, grid);
}

/// @throws Error (Fault::usage) if doubtful voxels are asked for where there are none.
void check_options(const Options& options) {
    const bool by_outside = options.solid == voxelizer::SolidRule::outside;
    if (options.doubtful && !options.solid)
        throw Error(Fault::usage, "--doubtful", "voxels that the surface touches are not in doubt",
                    "give --fill solid or --fill parity, too");
    if (options.doubtful && by_outside)
        throw Error(Fault::usage, "--doubtful", "what the outside cannot reach is not in doubt",
                    "give --fill solid or --fill parity instead");
    if ((options.doubtful || by_outside) && options.voxelization.method != voxelizer::Method::conservative)
        throw Error(Fault::usage, options.doubtful ? "--doubtful" : "--fill outside",
                    "the outside comes in through the gaps that this method leaves",
                    "leave out --method: the default leaves none");
}

/// @return milliseconds spent on writing
double voxelize(Voxelization& voxelization, voxelizer::VoxelWriter* writer, voxelizer::VoxelWriter* doubtful,
                bool quiet) {
    double write_ms = 0.0;
    {
        Progress progress("voxelizing", quiet);
        voxelization.run(
            [&](voxelizer::VoxelTile&& tile) {
                if (writer == nullptr) return;
                Stopwatch watch;
                writer->add(tile);
                write_ms += watch.lap_ms();
            },
            [&progress](double share) {
                progress.set(share);
                return true;
            },
            doubtful != nullptr ? [doubtful](voxelizer::VoxelTile&& tile) { doubtful->add(tile); }
                                : voxelizer::TileSink());
    }
    for (voxelizer::VoxelWriter* const each : {writer, doubtful}) {
        if (each == nullptr) continue;
        {
            const Progress progress("writing", quiet);
            Stopwatch watch;
            each->finish();
            write_ms += watch.lap_ms();
        }
        if (const std::string warning = each->warning(); !warning.empty()) warn(warning);
    }
    return write_ms;
}

ExitCode run(const Options& options) {
    check_options(options);
    Report report(options.voxelization.common.report);
    GriddedInput scene = load_gridded(options.voxelization);
    std::unique_ptr<voxelizer::VoxelWriter> writer;
    if (options.output) writer = make_writer(*options.output, scene.grid);
    std::unique_ptr<voxelizer::VoxelWriter> doubtful;
    if (options.doubtful) doubtful = make_writer(*options.doubtful, scene.grid);
    Voxelization voxelization(options.voxelization, std::move(scene),
                              {.attributes = writer && writer->wants_attributes() && !options.plain,
                               .solid = options.solid,
                               .doubts = options.doubtful.has_value()});
    const double write_ms =
        voxelize(voxelization, writer.get(), doubtful.get(), options.voxelization.common.report.quiet);
    voxelization.report(report);
    if (options.output) {
        report.add("write_ms", write_ms);
        report.add("output", options.output->string());
    }
    if (options.doubtful) report.add("doubtful_output", options.doubtful->string());
    report.add("peak_rss_bytes", peak_rss_bytes());
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_voxelize(CLI::App& command, Work& chosen) {
    add_verb<Options>(command, chosen, "voxelize", "Mark every voxel that the surface touches, on the GPU",
                      add_options, run);
}

}  // namespace cairn::app
