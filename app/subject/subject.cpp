#include "app/subject/subject.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/subject/scene_input.h"
#include "app/terminal/progress.h"
#include "app/terminal/terminal.h"
#include "base/error.h"

namespace cairn::app {
namespace {

using renderer::ContentKind;

[[noreturn]] void refuse(const std::string& option, const std::string& what, const std::string& way_out) {
    throw Error(Fault::usage, option, what, way_out);
}

/// @throws Error (Fault::usage) if an option does not apply to the kind of content.
void check_kind(ContentKind kind, const SceneOptions& scene, const ViewOptions& options) {
    if (options.zoom != 0 && kind != ContentKind::fractal)
        refuse("--zoom", "this scene has a finest level", "use --camera, or builtin:fractal");
    if (options.max_resolution && kind == ContentKind::fractal)
        refuse("--max-resolution", "builtin:fractal has no finest level",
               "leave the option out; --pixel-error makes voxels coarser");
    if (kind == ContentKind::volume) {
        if (scene.seconds || scene.animation || scene.scene_index)
            refuse(scene.scene, "a volume has no moments and no scenes",
                   "leave out --time, --animation and --scene-index");
        return;
    }
    const std::pair<bool, const char*> of_volumes[] = {
        {options.transfer.has_value(), "--transfer"},
        {options.copies != 1, "--copies"},
        {options.steps_per_voxel.has_value(), "--steps-per-voxel"},
        {options.gradient_threshold.has_value(), "--gradient-threshold"}};
    for (const auto& [is_given, option] : of_volumes)
        if (is_given) refuse(option, "the scene is no volume", "it is for volumes only");
}

renderer::TreeOptions tree_of(const SceneOptions& scene, const ViewOptions& options) {
    const ContentKind kind = renderer::content_kind(scene.scene);
    renderer::TreeOptions tree = renderer::usual_tree(scene.scene);
    tree.n = options.tree_n.value_or(tree.n);
    const int usual_m = tree.n == 3 ? renderer::usual_tree("builtin:sponge").m : renderer::TreeOptions{}.m;
    tree.m = options.brick_m.value_or(usual_m);
    tree.max_resolution = options.max_resolution.value_or(tree.max_resolution);
    tree.mips = options.view.detail.kind == renderer::LevelOfDetail::Kind::blended;
    if (tree.max_resolution < tree.m)
        refuse("--max-resolution", fmt::format("{} is less than a brick, {}", tree.max_resolution, tree.m),
               "give at least as many");
    if (kind == ContentKind::fractal) tree.max_level = renderer::deepest_level(tree.n, tree.m);
    return tree;
}

renderer::ContentSource source_of(const SceneOptions& scene, const ViewOptions& options, bool quiet) {
    const renderer::ContentOptions content = content_options(scene, options);
    if (renderer::content_kind(scene.scene) == ContentKind::surface) {
        SceneInput input = load_input(scene, quiet);
        return {std::move(input.scene), std::move(input.snapshot), *content.tree};
    }
    const Progress progress("loading", quiet);
    renderer::ContentSource source(scene.scene, content);
    warn_of(source.warnings(), quiet);
    return source;
}

renderer::View fractal_view(const ViewOptions& options, const renderer::TreeOptions& tree) {
    renderer::View view = options.view;
    view.shadow = shadow_of(options);
    if (!options.camera_given) {
        view.camera.eye = {0.71, 0.53, 0.62};
        view.camera.target = {0.02, 0.01, 0.03};
    }
    // The middle is the low corner of a tile of every level under the root.
    const int level_bits = renderer::TreeShape{.n = tree.n, .m = tree.m}.n_shift();
    const int level = std::max(1, options.zoom / level_bits);
    const std::int64_t across = std::int64_t(1) << (level_bits * level);
    view.anchor = renderer::Tile{level, glm::i64vec3(across / 2)};
    const double unit = std::ldexp(1.0, level_bits * level - options.zoom);
    view.camera.eye *= unit;
    view.camera.target *= unit;
    view.light.position *= unit;
    return view;
}

}  // namespace

renderer::ContentOptions content_options(const SceneOptions& scene, const ViewOptions& options) {
    check_kind(renderer::content_kind(scene.scene), scene, options);
    renderer::ContentOptions content{
        .tree = tree_of(scene, options),
        .load = scene.load,
        .copies = options.copies,
        .transfer = options.transfer.value_or(parse_transfer(default_transfer)).points};
    renderer::VolumeOptions& volume = content.volume;
    volume.steps_per_voxel = options.steps_per_voxel.value_or(volume.steps_per_voxel);
    volume.full_gradient = options.gradient_threshold.value_or(volume.full_gradient);
    return content;
}

Subject::Subject(const SceneOptions& scene, const ViewOptions& options, bool quiet)
    : source_(source_of(scene, options, quiet)) {}

void Subject::add_figures(Report& report) const {
    if (const scenes::Snapshot* const snapshot = source_.snapshot())
        report.add("triangles", snapshot->triangle_count);
    if (const auto voxels = source_.voxels()) report.add("voxels", json_of(*voxels));
}

std::vector<std::string> Subject::unmet(const ViewOptions& options, const renderer::View& view) const {
    using Kind = renderer::ShadowQuality::Kind;
    std::vector<std::string> texts;
    if (options.cones && view.shadow.kind == Kind::none)
        texts.emplace_back("--cones changes nothing: there are no shadows; --shadow soft adds them");
    const bool wants_soft =
        (view.shadow.kind == Kind::rays && view.shadow.samples > 1) || view.shadow.kind == Kind::cones;
    if (wants_soft && !optics::has_extent(view.light))
        texts.push_back(
            fmt::format("{}: the light has no extent, so its shadows are hard; --light X,Y,Z,RADIUS "
                        "gives it one",
                        view.shadow.kind == Kind::cones ? "--cones" : "--shadow soft"));
    const std::optional<std::int64_t> finest = finest_resolution();
    const std::optional<glm::i64vec3> samples = source_.voxels();
    // A volume has no more voxels than samples.
    const bool all_of_volume = samples && finest == std::max({samples->x, samples->y, samples->z});
    if (options.max_resolution && finest && *finest != *options.max_resolution && !all_of_volume)
        texts.push_back(
            fmt::format("--max-resolution {}: rays ask for at most {} voxels across, because a level has {} "
                        "times as many as the one above it",
                        *options.max_resolution, *finest, tree().n));
    return texts;
}

renderer::View Subject::view(const ViewOptions& options) const {
    if (kind() == ContentKind::fractal) return fractal_view(options, tree());
    if (const scenes::Snapshot* const snapshot = source_.snapshot()) return view_of(options, *snapshot);
    scenes::Snapshot only_bounds;
    only_bounds.bounds = bounds();
    return view_of(options, only_bounds);
}

}  // namespace cairn::app
