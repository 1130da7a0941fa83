#include <filesystem>
#include <optional>

#include "app/subject/scene_input.h"
#include "app/terminal/measure.h"
#include "app/terminal/report.h"
#include "app/verbs/verbs.h"
#include "scenes/write_glb.h"

namespace cairn::app {
namespace {

struct Options {
    SceneOptions scene;
    ReportOptions report;
    std::optional<std::filesystem::path> output;
};

void add_options(CLI::App& verb, Options& options) {
    add_scene_argument(verb, options.scene);
    add_output_option(verb, options.output, {".glb"}, "the file to write")->required();
    add_report_options(verb, options.report);
}

ExitCode run(const Options& options) {
    Stopwatch watch;
    Report report(options.report);
    const SceneInput input = load_input(options.scene, options.report.quiet);
    report.add("scene", options.scene.scene);
    report.add("load_ms", watch.lap_ms());
    scenes::write_glb(input.scene, *options.output);
    report.add("write_ms", watch.lap_ms());
    report.add("output", options.output->string());
    if (!is_device(*options.output)) report.add("output_bytes", std::filesystem::file_size(*options.output));
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_export(CLI::App& command, Work& chosen) {
    add_verb<Options>(command, chosen, "export",
                      "Write the rest pose of a scene as .glb, a built-in one for instance", add_options,
                      run);
}

}  // namespace cairn::app
