#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/produce/volume_field.h"
#include "renderer/renderer.h"
#include "scenes/snapshot.h"

namespace cairn::app {

/// The volumes that need no file, for the help: "builtin:NAME" and what it is, one a line.
[[nodiscard]] std::string builtin_volumes_help();

/// Is it a volume, by its name: a file's ending or a built-in volume?
[[nodiscard]] bool is_volume(const std::string& scene);

struct VolumeInput {
    std::shared_ptr<const renderer::Field> field;
    std::vector<std::string> warnings;
};

/// @param tree    the field is made for its n; formulas, for its max_resolution.
/// @param copies  along each axis.
[[nodiscard]] VolumeInput load_volume_input(const std::string& scene, const renderer::TreeOptions& tree,
                                            int copies);

[[nodiscard]] scenes::Bounds bounds_of(const renderer::Field& field);

}  // namespace cairn::app
