#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "bench/trials/chart.h"

namespace cairn::bench {

/// A scene of Debian's package assimp-testmodels.
constexpr const char* engine_path =
    "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";

/// Adds the real scenes that exist to `scenes`, and a note to the chart for each that does not.
/// @param names  files in options.scene_folder, or absolute paths
void add_real_scenes(Chart& chart, const ChartOptions& options, std::initializer_list<const char*> names,
                     std::vector<std::string>& scenes);

/// The name of a scene in a table: a built-in scene by its name, a file by its stem.
[[nodiscard]] std::string scene_name(const std::string& scene);

}  // namespace cairn::bench
