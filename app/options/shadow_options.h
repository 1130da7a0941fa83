#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/options/options.h"
#include "app/options/view_options.h"
#include "app/subject/scene_input.h"
#include "renderer/renderer.h"
#include "renderer/shadow/soft_shadow_map.h"
#include "scenes/node_selection.h"

namespace cairn::app {

enum class ShadowMethod : std::uint8_t { voxel, pyramid, soft_shadow_map, embree };

struct ShadowOptions {
    CommonOptions common;
    ViewOptions view;
    std::optional<ShadowMethod> method;
    bool compare = false;  ///< with Embree
    std::optional<std::filesystem::path> output;
    std::optional<std::filesystem::path> difference;
    std::optional<int> rays;
    bool cones = false;                      ///< in place of rays
    std::optional<optics::Light> direction;  ///< from --light-direction
    std::optional<glm::dvec2> rectangle;     ///< width and height
    std::optional<double> disk;              ///< radius
    std::optional<glm::dvec3> target;        ///< what a rectangle or a disk shines on
    std::vector<std::string> occluders, receivers;
    renderer::SoftShadowOptions map;
    bool map_given = false;                       ///< any of its options
    bool ground = false;                          ///< a plane is added under the scene
    const CLI::Option* max_resolution = nullptr;  ///< to ask whether it was given
    int truth_samples = 256;
    std::optional<std::filesystem::path> truth_cache;
};
void add_shadow_options(CLI::App& verb, ShadowOptions& options);

/// What a shadow is computed of: the nodes that were chosen, and the view with its light.
struct ShadowTask {
    SceneInput input;
    scenes::NodeSelection occluders, receivers;
    scenes::Snapshot shown;  ///< of both
    renderer::View view;
    bool is_soft = false;  ///< the light has an extent, and more than its middle is asked for
};
/// Voxels a side of the pyramid: --max-resolution, where it was given.
[[nodiscard]] int pyramid_resolution(const ShadowOptions& options);

/// @throws Error (Fault::usage) when the options contradict each other; before anything is written.
[[nodiscard]] ShadowTask make_shadow_task(const ShadowOptions& options);

}  // namespace cairn::app
