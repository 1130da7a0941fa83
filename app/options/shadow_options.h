#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/options/names.h"
#include "app/options/option_table.h"
#include "app/options/options.h"
#include "app/options/view_options.h"
#include "optics/light.h"
#include "renderer/shadow/shadow_base.h"

namespace cairn::app {

/// The methods of the renderer, and Embree's rays as the truth.
enum class ShadowMethod : std::uint8_t { voxel, pyramid, soft_shadow_map, embree };

struct ShadowOptions {
    CommonOptions common;
    ViewOptions view;
    std::optional<ShadowMethod> method;
    bool compare = false;  ///< compare with Embree's rays
    std::optional<std::filesystem::path> output;
    std::optional<std::filesystem::path> difference;
    std::optional<int> rays;
    bool cones = false;                      ///< cones instead of rays
    std::optional<optics::Light> direction;  ///< light of --light-direction
    std::optional<glm::dvec2> rectangle;     ///< width and height of --light-size
    std::optional<double> disk;              ///< radius of --light-disk
    std::optional<glm::dvec3> target;        ///< point that a rectangle or a disk faces
    std::vector<std::string> occluders, receivers;
    renderer::SoftShadowOptions map;
    bool map_given = false;  ///< any option of `map` was given
    bool ground = false;     ///< a plane is added under the scene
    int truth_samples = 256;
    std::optional<std::filesystem::path> truth_cache;
};
[[nodiscard]] Names<ShadowMethod> shadow_method_names();

/// The options of `cairn shadow` alone, without files and lists of nodes.
[[nodiscard]] OptionTable<ShadowOptions> shadow_option_table();
/// Those of them that only Embree's rays know.
[[nodiscard]] OptionTable<ShadowOptions> truth_table();
/// Adds all options of `cairn shadow`.
void add_shadow_options(CLI::App& verb, ShadowOptions& options);

}  // namespace cairn::app
