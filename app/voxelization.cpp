#include "app/voxelization.h"

#include <fmt/format.h>

#include "app/driver.h"
#include "app/measure.h"
#include "app/progress.h"
#include "app/scene_input.h"
#include "base/error.h"
#include "voxelizer/voxelizer.h"

namespace cairn::app {

void add_voxelization_options(CLI::App& verb, VoxelizationOptions& options) {
    add_grid_options(verb, options.grid);
    add_parsed_option(
        verb, "--method", "NAME", "conservative, slice-map, three-axis, three-axis-conservative",
        [&options](const std::string& name) { options.method = voxelizer::method_named(name); });
    add_common_options(verb, options.common);
}

Voxelization voxelize_input(const VoxelizationOptions& options, Report& report) {
    const bool quiet = options.common.report.quiet;
    Stopwatch watch;
    Voxelization out;
    double load_ms = 0.0;
    {
        const SceneInput input = load_input(options.common.scene, quiet);
        load_ms = watch.lap_ms();
        const voxelizer::Grid grid =
            options.grid.bounds ? voxelizer::grid_over(*options.grid.bounds, options.grid.resolution)
                                : voxelizer::grid_around(input.snapshot.bounds, options.grid.resolution);
        out.surface = voxelizer::build_surface(input.scene, input.snapshot, grid);
    }
    out.region = voxelizer::whole(out.surface.grid);
    const double surface_ms = watch.lap_ms();

    const Progress progress("voxelizing", quiet);
    const Driver driver(options.common.driver);
    const double context_ms = watch.lap_ms();
    const voxelizer::GpuSurface on_gpu = voxelizer::upload(out.surface);
    const double upload_ms = watch.lap_ms();
    const std::unique_ptr<voxelizer::Voxelizer> voxelizer =
        voxelizer::make_voxelizer(options.method, options.common.driver.shaders);
    // Once for the driver, which compiles at the first use; once for the clock.
    out.voxels = voxelizer->voxelize(on_gpu, out.region);
    out.voxels = voxelizer->voxelize(on_gpu, out.region);
    driver.check();

    const voxelizer::Grid& grid = out.surface.grid;
    report.add("scene", options.common.scene.scene);
    report.add("triangles", out.surface.triangle_count);
    report.add("resolution", grid.resolution.x);
    report.add("origin", json_of(grid.origin));
    report.add("voxel_size", grid.voxel_size);
    report.add("method", std::string(voxelizer::name_of(options.method)));
    report.add("occupied", out.voxels.count());
    report.add("milliseconds", voxelizer->last_milliseconds());
    report.add("load_ms", load_ms);
    report.add("surface_ms", surface_ms);
    report.add("context_ms", context_ms);
    report.add("upload_ms", upload_ms);
    report.add("driver", driver.name());
    report.add("backend", driver.backend());
    return out;
}

}  // namespace cairn::app
