#include "app/subject/fractal.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "renderer/pool/tree_shape.h"

namespace cairn::app {
namespace {

/// For N = 4 and M = 16.
constexpr int deepest_level = 28;
constexpr int finest_sponge = 1594323;  // 3^13

}  // namespace

bool is_fractal(const SceneOptions& scene) {
    return scene.scene == "builtin:fractal";
}

bool is_sponge(const SceneOptions& scene) {
    return scene.scene == "builtin:sponge";
}

renderer::TreeOptions fractal_tree(const ViewOptions& options) {
    renderer::TreeOptions tree = options.tree;
    if (tree.max_resolution != renderer::TreeOptions{}.max_resolution) {
        throw Error(Fault::usage, "--max-resolution", "builtin:fractal has no finest level",
                    "leave the option out; --pixel-error makes voxels coarser");
    }
    tree.max_level = deepest_level;
    return tree;
}

renderer::TreeOptions sponge_tree(const ViewOptions& options) {
    renderer::TreeOptions tree = options.tree;
    tree.n = 3;
    tree.m = 27;
    if (tree.max_resolution == renderer::TreeOptions{}.max_resolution) tree.max_resolution = finest_sponge;
    return tree;
}

renderer::View fractal_view(const ViewOptions& options, int zoom) {
    renderer::View view = options.view;
    if (!options.camera_given) {
        view.camera.eye = {0.71, 0.53, 0.62};
        view.camera.target = {0.02, 0.01, 0.03};
    }
    // The middle is the low corner of a tile of every level under the root.
    const int level_bits = renderer::TreeShape{.n = options.tree.n, .m = options.tree.m}.n_shift();
    const int level = std::max(1, zoom / level_bits);
    const std::int64_t across = std::int64_t(1) << (level_bits * level);
    view.anchor = renderer::Tile{level, glm::i64vec3(across / 2)};
    const double unit = std::ldexp(1.0, level_bits * level - zoom);
    view.camera.eye *= unit;
    view.camera.target *= unit;
    view.light.position *= unit;
    return view;
}

}  // namespace cairn::app
