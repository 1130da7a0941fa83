#include "app/verbs/shadow_task.h"

#include "base/error.h"
#include "optics/light.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::app {
namespace {

[[noreturn]] void refuse(const char* option, const char* what, const char* way_out) {
    throw Error(Fault::usage, option, what, way_out);
}

/// @throws Error (Fault::usage) if an option of the table is not as it would be if it were not given.
template <typename Options>
void refuse_given(const OptionTable<Options>& table, const Options& options, const char* why) {
    const Options usual{};
    for (const OptionRow<Options>& row : table)
        if (row.print(options) != row.print(usual))
            refuse(row.long_name().c_str(), "it changes nothing", why);
}

void refuse_voxel_options(const ShadowOptions& options);

void check_shadow_options(const ShadowOptions& options) {
    if (!options.method)
        refuse("--method", "it is missing", "choose voxel, pyramid, soft-shadow-map or embree");
    const bool is_map = *options.method == ShadowMethod::soft_shadow_map;
    if (options.direction && options.view.light_given)
        refuse("--light-direction", "there is a --light already", "give one of them");
    const bool has_axes = options.rectangle || options.disk;
    if (options.rectangle && options.disk)
        refuse("--light-disk", "the light is a rectangle", "give one of them");
    if (has_axes && !options.view.light_given)
        refuse(options.disk ? "--light-disk" : "--light-size", "the light has no place",
               "give it with --light");
    if (has_axes && options.view.view.light.radius > 0.0)
        refuse("--light", "a sphere is no rectangle and no disk", "leave out its fourth number");
    if (options.target && !has_axes)
        refuse("--light-target", "only a rectangle or a disk has one", "add --light-size or --light-disk");
    if (options.map_given && !is_map)
        refuse("--method", "--map-size, --passes and --format are of soft-shadow-map", "leave them out");
    if (is_map && !options.rectangle)
        refuse("--method", "soft shadow maps need a rectangle", "add --light and --light-size");
    if (is_map && options.rays) refuse("--rays", "soft shadow maps send none", "leave it out");
    if (options.cones && *options.method != ShadowMethod::voxel)
        refuse("--cones", "only voxels are seen by cones", "leave it out, or choose --method voxel");
    if (is_map && options.occluders.empty() && options.receivers.empty())
        refuse("--method", "soft shadow maps have no self-shadowing", "name --occluders or --receivers");
    if (options.difference && !options.compare)
        refuse("--difference", "nothing is compared", "add --compare embree");
    if (*options.method != ShadowMethod::embree && !options.compare)
        refuse_given(truth_table(), options,
                     "they are of Embree's rays: choose --method embree or --compare embree");
    refuse_voxel_options(options);
}

/// @throws Error (Fault::usage) if options of the tree are given to a method that has none.
void refuse_voxel_options(const ShadowOptions& options) {
    if (*options.method == ShadowMethod::voxel) return;
    ViewOptions given = options.view;
    // The pyramid has as many voxels across.
    if (*options.method == ShadowMethod::pyramid) given.max_resolution.reset();
    refuse_given(tree_table(), given, "they are of --method voxel");
}

/// A light without an extent throws hard shadows, by one ray to its middle.
void check_extent(const ShadowOptions& options, const optics::Light& light) {
    if (optics::has_extent(light)) return;
    constexpr const char* way_out =
        "give --light a radius, --light-size or --light-disk, or --light-direction an angle";
    if (options.rays && *options.rays > 1) refuse("--rays", "the light has no extent", way_out);
    if (options.cones) refuse("--cones", "the light has no extent", way_out);
}

optics::Light light_of(const ShadowOptions& options, const optics::Light& given,
                       const scenes::Bounds& bounds) {
    if (options.direction) return *options.direction;
    optics::Light light = given;
    if (!options.rectangle && !options.disk) return light;
    const glm::dvec3 target = options.target.value_or(0.5 * (bounds.low + bounds.high));
    const glm::dvec2 size = options.rectangle.value_or(glm::dvec2(2.0 * options.disk.value_or(1.0)));
    const optics::Light aimed = optics::aimed_light(light.position, target, size.x, size.y);
    light.shape = options.disk ? optics::LightShape::disk : optics::LightShape::rectangle;
    light.half_u = aimed.half_u;
    light.half_v = aimed.half_v;
    return light;
}

}  // namespace

int pyramid_resolution(const ShadowOptions& options) {
    constexpr int usual = 512;
    return options.view.max_resolution.value_or(usual);
}

int tree_resolution(const ShadowOptions& options) {
    return options.view.max_resolution.value_or(renderer::TreeOptions{}.max_resolution);
}

ShadowTask make_shadow_task(const ShadowOptions& options) {
    check_shadow_options(options);
    ShadowTask task{load_input(options.common.scene, options.common.report.quiet), {}, {}, {}, {}};
    if (options.ground) add_ground(task.input);
    const std::size_t nodes = task.input.scene.nodes.size();
    if (options.occluders.empty() && options.receivers.empty()) {
        task.occluders = task.receivers = scenes::NodeSelection(nodes, true);
    } else if (options.receivers.empty()) {
        task.occluders = scenes::select_nodes(task.input.scene, options.occluders);
        task.receivers = scenes::other_nodes(task.occluders);
    } else {
        task.receivers = scenes::select_nodes(task.input.scene, options.receivers);
        task.occluders = options.occluders.empty()
                             ? scenes::other_nodes(task.receivers)
                             : scenes::select_nodes(task.input.scene, options.occluders);
    }
    scenes::NodeSelection both = task.occluders;
    for (std::size_t i = 0; i < nodes; ++i)
        both[i] = both[i] || task.receivers[i];
    task.shown = scenes::part_of(task.input.snapshot, both);
    task.view = view_of(options.view, task.input.snapshot);
    task.view.light = light_of(options, task.view.light, task.shown.bounds);
    check_extent(options, task.view.light);
    const bool extended = optics::has_extent(task.view.light);
    task.view.shadow.samples = options.rays.value_or(extended ? default_soft_rays : 1);
    task.view.shadow.kind =
        options.cones ? renderer::ShadowQuality::Kind::cones : renderer::ShadowQuality::Kind::rays;
    return task;
}

}  // namespace cairn::app
