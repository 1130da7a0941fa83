#include "app/measure.h"
#include "app/progress.h"
#include "app/report.h"
#include "app/verbs.h"
#include "app/voxelization.h"
#include "reference/exact_voxels.h"

namespace cairn::app {
namespace {

ExitCode run(const VoxelizationOptions& options) {
    Report report(options.common.report);
    const Voxelization result = voxelize_input(options, report);

    Stopwatch watch;
    reference::Comparison comparison;
    {
        const Progress progress("computing the reference", options.common.report.quiet);
        comparison =
            reference::compare(result.voxels, reference::exact_voxels(result.surface, result.region));
    }
    report.add("reference_ms", watch.lap_ms());
    report.add("missing", comparison.missing);
    report.add("extra", comparison.extra);
    const bool same = comparison.missing == 0 && comparison.extra == 0;
    if (!same) {
        Json first = Json::array();
        for (const glm::ivec3& voxel : comparison.first_different) {
            first.push_back(
                {{"voxel", json_of(voxel)}, {"is", result.voxels.at(voxel) ? "extra" : "missing"}});
        }
        report.add("first_different", std::move(first));
    }
    report.finish();
    return same ? ExitCode::done : ExitCode::differs;
}

}  // namespace

void add_check(CLI::App& command, Work& chosen) {
    add_verb<VoxelizationOptions>(command, chosen, "check", "Voxelize, and compare with the exact reference",
                                  add_voxelization_options, run);
}

}  // namespace cairn::app
