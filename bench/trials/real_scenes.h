#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "bench/trials/chart.h"

namespace cairn::bench {

/// From Debian's assimp-testmodels.
constexpr const char* engine_path =
    "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";

/// Adds real scenes that are there; notes those that are not.
/// @param names  files in options.scene_folder; with a leading slash, full paths
void add_real_scenes(Chart& chart, const ChartOptions& options, std::initializer_list<const char*> names,
                     std::vector<std::string>& scenes);

/// How a table names a scene: a built-in one by its name, a file by its stem.
[[nodiscard]] std::string scene_name(const std::string& scene);

}  // namespace cairn::bench
