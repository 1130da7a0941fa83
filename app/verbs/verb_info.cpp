#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/options/options.h"
#include "app/subject/scene_input.h"
#include "app/terminal/report.h"
#include "app/verbs/verbs.h"
#include "renderer/open_content.h"
#include "scenes/volume/volume.h"

namespace cairn::app {
namespace {

/// Elements of one topology in the file, each mesh counted once however often it is placed.
std::uint64_t count_stored(const scenes::Scene& scene, scenes::Topology topology) {
    std::uint64_t count = 0;
    for (const scenes::Mesh& mesh : scene.meshes) {
        for (const scenes::Primitive& primitive : mesh.primitives) {
            if (primitive.topology == topology) count += primitive.element_count();
        }
    }
    return count;
}

std::size_t most_morph_targets(const scenes::Scene& scene) {
    std::size_t most = 0;
    for (const scenes::Mesh& mesh : scene.meshes) {
        for (const scenes::Primitive& primitive : mesh.primitives) {
            most = std::max(most, primitive.morph_targets.size());
        }
    }
    return most;
}

std::size_t count_images_used(const scenes::Scene& scene) {
    std::set<int> used;
    for (const scenes::Material& material : scene.materials) {
        if (material.texture >= 0) used.insert(scene.textures[std::size_t(material.texture)].image);
    }
    used.erase(-1);
    return used.size();
}

Json list_animations(const scenes::Scene& scene) {
    Json list = Json::array();
    for (std::size_t i = 0; i < scene.animations.size(); ++i) {
        const scenes::Animation& animation = scene.animations[i];
        list.push_back({{"index", i}, {"name", animation.name}, {"seconds", animation.duration}});
    }
    return list;
}

Json list_scenes(const scenes::Scene& scene) {
    Json list = Json::array();
    for (std::size_t i = 0; i < scene.scenes.size(); ++i) {
        list.push_back(
            {{"index", i}, {"name", scene.scenes[i].name}, {"default", int(i) == scene.default_scene}});
    }
    return list;
}

Json texts_of(const std::vector<scenes::Warning>& warnings) {
    Json texts = Json::array();
    for (const scenes::Warning& warning : warnings)
        texts.push_back(warning.text);
    return texts;
}

ExitCode run_volume_or_set(const CommonOptions& options) {
    Report report(options.report);
    report.add("scene", options.scene.scene);
    scenes::Bounds bounds;
    std::vector<scenes::Warning> warnings;
    if (scenes::is_volume_file(options.scene.scene)) {
        const scenes::Volume volume = scenes::load_volume(options.scene.scene, options.scene.load);
        report.add("samples", json_of(volume.size));
        report.add("spacing", json_of(volume.spacing));
        report.add("least_value", volume.low);
        report.add("greatest_value", volume.high);
        bounds = volume.bounds();
        warnings = volume.warnings;
    } else {
        bounds = renderer::ContentSource(options.scene.scene).bounds();
    }
    report.add("bounds_low", json_of(bounds.low));
    report.add("bounds_high", json_of(bounds.high));
    warn_of(warnings, options.report.quiet);
    report.add("warnings", texts_of(warnings));
    report.finish();
    return ExitCode::done;
}

ExitCode run(const CommonOptions& options) {
    if (renderer::content_kind(options.scene.scene) != renderer::ContentKind::surface)
        return run_volume_or_set(options);
    const SceneInput input = load_input(options.scene, options.report.quiet);
    const scenes::Scene& scene = input.scene;
    const scenes::Snapshot& snapshot = input.snapshot;
    Report report(options.report);
    report.add("scene", options.scene.scene);
    report.add("scenes", list_scenes(scene));
    report.add("nodes", scene.nodes.size());
    report.add("meshes", scene.meshes.size());
    report.add("triangles_in_file", count_stored(scene, scenes::Topology::triangles));
    report.add("triangles", snapshot.triangle_count);
    report.add("lines", snapshot.line_count);
    report.add("points", snapshot.point_count);
    report.add("materials", scene.materials.size());
    report.add("textures", scene.textures.size());
    report.add("images", scene.images.size());
    report.add("images_used", count_images_used(scene));
    report.add("animations", list_animations(scene));
    report.add("skins", scene.skins.size());
    report.add("morph_targets", most_morph_targets(scene));
    report.add("lights", scene.lights.size());
    report.add("cameras", scene.cameras.size());
    const bool empty = snapshot.bounds.empty();
    report.add("bounds_low", empty ? Json() : json_of(snapshot.bounds.low));
    report.add("bounds_high", empty ? Json() : json_of(snapshot.bounds.high));
    report.add("warnings", texts_of(scene.warnings));
    report.finish();
    return ExitCode::done;
}

}  // namespace

void add_info(CLI::App& command, Work& chosen) {
    add_verb<CommonOptions>(command, chosen, "info", "Say what a scene holds; needs no OpenGL",
                            add_common_options, run);
}

}  // namespace cairn::app
