#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "app/options/shadow_options.h"
#include "app/terminal/driver.h"
#include "app/terminal/measure.h"
#include "app/terminal/png.h"
#include "app/terminal/report.h"
#include "app/verbs/shadow_methods.h"
#include "app/verbs/shadow_task.h"
#include "app/verbs/verbs.h"
#include "reference/shadow_truth.h"

namespace cairn::app {
namespace {

/// The renderer's method; none for Embree, which needs no OpenGL.
std::optional<renderer::ShadowMethod> gpu_method(ShadowMethod method) {
    switch (method) {
        case ShadowMethod::voxel:
            return renderer::ShadowMethod::voxel;
        case ShadowMethod::pyramid:
            return renderer::ShadowMethod::pyramid;
        case ShadowMethod::soft_shadow_map:
            return renderer::ShadowMethod::soft_shadow_map;
        case ShadowMethod::embree:
            break;
    }
    return std::nullopt;
}

void add_comparison(Report& report, const ShadowTask& task, const ShadowOptions& options,
                    const ShadowResult& shadow) {
    const ShadowResult truth = shadow_by_embree(task, options, options.truth_cache);
    const reference::ShadowError error = reference::shadow_error(shadow.shares, truth.shares);
    report.add("shadowable_pixels", error.pixels);
    report.add("shadowed_pixels", error.shadowed);
    report.add("hard_disagreement", error.disagreement());
    report.add("too_light_pixels", error.too_light);
    report.add("too_dark_pixels", error.too_dark);
    report.add("mean_absolute_error", error.mean_absolute());
    report.add("error_in_shadow", error.mean_in_shadow());
    report.add("rmse", error.rmse());
    report.add("max_error", error.greatest);
    report.add("truth_std_error", truth.standard_error);
    if (truth.cached) {
        report.add("truth", "from the cache");
    } else {
        report.add("truth_ms", truth.milliseconds);
    }
    if (options.difference) write_png(difference_image(shadow, truth.shares), *options.difference);
}

ExitCode run(const ShadowOptions& options) {
    if (options.output) check_writable(*options.output);
    if (options.difference) check_writable(*options.difference);
    Report report(options.common.report);
    Stopwatch watch;
    const ShadowTask task = make_shadow_task(options);
    const ShadowMethod method = *options.method;
    report.add("scene", options.common.scene.scene);
    report.add("method", name_of(method, shadow_method_names()));
    report.add("load_ms", watch.lap_ms());
    report.add("triangles", task.shown.triangle_count);
    report.add("width", task.view.size.width);
    report.add("height", task.view.size.height);
    std::optional<Driver> driver;
    const std::optional<renderer::ShadowMethod> on_gpu = gpu_method(method);
    if (on_gpu) driver.emplace(options.common.driver);
    const ShadowResult shadow =
        on_gpu ? shadow_on_gpu(*on_gpu, task, options) : shadow_by_embree(task, options);
    if (driver) driver->check();
    if (method == ShadowMethod::voxel) {
        report.add("rays", renderer::shadow_samples(task.view));
        report.add("max_resolution", tree_resolution(options));
    }
    if (method == ShadowMethod::pyramid) {
        report.add("rays", renderer::shadow_samples(task.view));
        report.add("max_resolution", pyramid_resolution(options));
        report.add("voxelize_ms", shadow.voxelize_ms);
        report.add("pyramid_ms", shadow.pyramid_ms);
    }
    report.add("milliseconds", shadow.milliseconds);
    report.add("first_frame_ms", shadow.first_frame_ms);
    if (options.compare) add_comparison(report, task, options, shadow);
    if (options.output) {
        write_png(shadow.image, *options.output);
        report.add("output", options.output->string());
    }
    report.add("peak_rss_bytes", peak_rss_bytes());
    report.add("driver", driver ? driver->name() : std::string("Embree"));
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_shadow(CLI::App& command, Work& chosen) {
    add_verb<ShadowOptions>(command, chosen, "shadow",
                            "Compute a shadow by one of several methods, and its error", add_shadow_options,
                            run);
}

}  // namespace cairn::app
