#include "app/subject/scene_input.h"

#include <charconv>

#include <fmt/format.h>

#include "app/terminal/progress.h"
#include "app/terminal/terminal.h"
#include "base/error.h"
#include "renderer/open_content.h"
#include "scenes/ground.h"
#include "scenes/load.h"

namespace cairn::app {
namespace {

/// Names come before indices, so that an animation called "1" can be chosen.
int animation_called(const scenes::Scene& scene, const std::string& name) {
    std::string known;
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        if (scene.animations[i].name == name) return int(i);
        known += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, scene.animations[i].name);
    }
    int index = -1;
    const char* const end = name.data() + name.size();
    const auto [stop, failed] = std::from_chars(name.data(), end, index);
    if (failed == std::errc() && stop == end && index >= 0 && std::size_t(index) < scene.animations.size())
        return index;
    throw Error(Fault::usage, "--animation", fmt::format("{} has no animation \"{}\"", scene.name, name),
                known.empty() ? "it has none at all" : "it has " + known);
}

}  // namespace

SceneInput load_input(const SceneOptions& options, bool quiet) {
    switch (renderer::content_kind(options.scene)) {
        case renderer::ContentKind::surface:
            break;
        case renderer::ContentKind::volume:
            throw Error(Fault::usage, options.scene, "this verb needs surfaces, and that is a volume",
                        "\"cairn render\", \"cairn view\" and \"cairn info\" take volumes");
        case renderer::ContentKind::fractal:
            throw Error(Fault::usage, options.scene,
                        "this verb needs surfaces, and that is a set by its formula",
                        "\"cairn render\" and \"cairn info\" take it");
        case renderer::ContentKind::sponge:
            throw Error(Fault::usage, options.scene,
                        "this verb needs surfaces, and that is a set by its formula",
                        "\"cairn render\", \"cairn view\" and \"cairn info\" take it");
    }
    const Progress progress("loading", quiet);
    SceneInput input{scenes::load(options.scene, options.load), {}, {}};
    scenes::When& when = input.when;
    when.seconds = options.seconds.value_or(0.0);
    when.scene_index = options.scene_index;
    if (options.animation) {
        when.animation = animation_called(input.scene, *options.animation);
    } else if (options.seconds && !input.scene.animations.empty()) {
        when.animation = 0;
    }
    warn_of(input.scene.warnings, quiet);
    if (!quiet && options.seconds && !when.animation)
        warn("--time changes nothing: the scene has no animation");
    input.snapshot = scenes::take_snapshot(input.scene, when);
    return input;
}

void warn_of(std::span<const scenes::Warning> warnings, bool quiet) {
    for (const scenes::Warning& warning : warnings)
        if (!quiet || warning.alters) warn(warning.text);
}

void add_ground(SceneInput& input) {
    constexpr double frames_per_second = 30.0;
    const scenes::Bounds bounds =
        input.when.animation ? scenes::bounds_over_animation(input.scene, input.when, frames_per_second)
                             : input.snapshot.bounds;
    scenes::add_ground(input.scene, bounds, input.when.scene_index);
    input.snapshot = scenes::take_snapshot(input.scene, input.when);
}

}  // namespace cairn::app
