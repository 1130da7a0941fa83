#include "app/subject/volume_input.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "renderer/produce/dense_field.h"
#include "renderer/produce/made_fields.h"
#include "scenes/volume/volume.h"

namespace cairn::app {
namespace {

struct BuiltinVolume {
    std::string_view name;
    std::string_view description;
    double inner, outer;  ///< radii of a shell, in shares of its cube's side
};

constexpr std::array builtin_volumes = {
    BuiltinVolume{"hollow-sphere", "a volume: a shell, by its formula at any resolution", 0.40, 0.45},
    BuiltinVolume{"ball", "a volume: a ball, likewise", 0.0, 0.45},
};

const BuiltinVolume* find_builtin(std::string_view scene) {
    constexpr std::string_view prefix = "builtin:";
    if (!scene.starts_with(prefix)) return nullptr;
    const auto* const found =
        std::find_if(builtin_volumes.begin(), builtin_volumes.end(),
                     [&](const auto& v) { return v.name == scene.substr(prefix.size()); });
    return found == builtin_volumes.end() ? nullptr : found;
}

}  // namespace

std::string builtin_volumes_help() {
    std::string text;
    for (const BuiltinVolume& volume : builtin_volumes)
        text += fmt::format("  builtin:{:<14}{}\n", volume.name, volume.description);
    return text;
}

bool is_volume(const std::string& scene) {
    return scenes::is_volume_file(scene) || find_builtin(scene) != nullptr;
}

VolumeInput load_volume_input(const std::string& scene, const renderer::TreeOptions& tree, int copies) {
    VolumeInput input;
    if (const BuiltinVolume* const builtin = find_builtin(scene)) {
        const int resolution = std::max(tree.max_resolution / copies, 1);
        input.field =
            std::make_shared<renderer::HollowSphere>(tree.n, resolution, builtin->inner, builtin->outer);
    } else {
        const scenes::Volume volume = scenes::load_volume(scene);
        input.warnings = volume.warnings;
        input.field = std::make_shared<renderer::DenseField>(volume, tree.n);
    }
    if (copies > 1) input.field = std::make_shared<renderer::RepeatedField>(input.field, copies);
    return input;
}

scenes::Bounds bounds_of(const renderer::Field& field) {
    const renderer::FieldFrame& frame = field.frame();
    return {frame.origin, frame.origin + frame.voxel_size * glm::dvec3(frame.size)};
}

}  // namespace cairn::app
