#include "renderer/shadow/shadow_checks.h"

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::renderer {

void check_selections(const ShadowScene& scene) {
    for (const auto* const selection : {&scene.casters, &scene.receivers}) {
        if (!*selection || (*selection)->size() == scene.scene.nodes.size()) continue;
        throw Error(
            Fault::usage, scene.scene.name,
            fmt::format("{} flags select among {} nodes", (*selection)->size(), scene.scene.nodes.size()),
            "give one flag per node");
    }
}

void check_casts_and_receives_all(const ShadowScene& scene) {
    check_selections(scene);
    for (const auto* const selection : {&scene.casters, &scene.receivers}) {
        if (!*selection) continue;
        for (const scenes::Item& item : scene.snapshot.items) {
            if (item.node < 0 || (**selection)[std::size_t(item.node)]) continue;
            throw Error(Fault::usage, scene.scene.name,
                        fmt::format("node {} \"{}\" shall {}, but shadow rays meet all that is shown",
                                    item.node, scene.scene.nodes[std::size_t(item.node)].name,
                                    selection == &scene.casters ? "throw no shadow" : "take no shadow"),
                        "leave it out of the snapshot, or choose soft shadow maps");
        }
    }
}

void check_shows_surface(const View& view) {
    if (view.show == Show::surface) return;
    throw Error(Fault::usage, "view", "this shadow has no levels and no bricks to show",
                "show the surface, or choose shadows by voxels");
}

}  // namespace cairn::renderer
