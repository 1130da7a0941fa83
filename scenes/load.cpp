#include "scenes/load.h"

#include <array>

#include "scenes/gltf/read_gltf.h"

namespace cairn::scenes {
namespace {

constexpr std::array names = {
    LimitName{"elements", &Limits::elements},       LimitName{"file-bytes", &Limits::file_bytes},
    LimitName{"image-bytes", &Limits::image_bytes}, LimitName{"json-bytes", &Limits::json_bytes},
    LimitName{"json-values", &Limits::json_values}, LimitName{"materials", &Limits::materials},
    LimitName{"primitives", &Limits::primitives},
};

}  // namespace

std::span<const LimitName> limit_names() {
    return names;
}

Scene load(const std::string& path_or_builtin, const LoadOptions& options) {
    constexpr std::string_view prefix = "builtin:";
    if (path_or_builtin.starts_with(prefix)) return make_builtin(path_or_builtin.substr(prefix.size()));
    return gltf::read_gltf(path_or_builtin, options);
}

}  // namespace cairn::scenes
