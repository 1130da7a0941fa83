#include "scenes/load.h"

#include "scenes/gltf/read_gltf.h"

namespace cairn::scenes {

Scene load(const std::string& path_or_builtin, const LoadOptions& options) {
    constexpr std::string_view prefix = "builtin:";
    if (path_or_builtin.starts_with(prefix)) return make_builtin(path_or_builtin.substr(prefix.size()));
    return gltf::read_gltf(path_or_builtin, options.trust_paths);
}

}  // namespace cairn::scenes
