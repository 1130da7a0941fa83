#include <filesystem>
#include <optional>

#include "app/measure.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/verbs.h"
#include "app/voxelization.h"
#include "voxelizer/write_npy.h"

namespace cairn::app {
namespace {

struct Options {
    VoxelizationOptions voxelization;
    std::optional<std::filesystem::path> output;
};

void add_options(CLI::App& verb, Options& options) {
    add_output_option(verb, options.output, {".npy"},
                      "write the voxels: .npy holds uint8 of shape (N, N, N),\na[x, y, z], 1 = occupied");
    add_voxelization_options(verb, options.voxelization);
}

ExitCode run(const Options& options) {
    Report report(options.voxelization.common.report);
    const Voxelization result = voxelize_input(options.voxelization, report);
    if (options.output) {
        const Progress progress("writing", options.voxelization.common.report.quiet);
        Stopwatch watch;
        voxelizer::write_npy(result.voxels, *options.output);
        report.add("write_ms", watch.lap_ms());
        report.add("output", options.output->string());
    }
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
