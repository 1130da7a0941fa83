#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "scenes/builtin/generators.h"
#include "scenes/load.h"

namespace cairn::scenes {
namespace {

struct Entry {
    Builtin builtin;
    Scene (*make)();
};

constexpr std::array entries = {
    Entry{{"knot", "a trefoil tube, 52,992 triangles"}, make_knot},
    Entry{{"spheres", "9 x 9 spheres in a cube, 6,848 triangles, shared meshes"}, make_spheres},
    Entry{{"tree", "a tree with every leaf modelled, about 600,000 triangles"},
          [] { return make_tree(Leaves::triangles); }},
    Entry{{"tree-leaves", "the same tree with alpha-masked leaf cards"},
          [] { return make_tree(Leaves::masked_cards); }},
    Entry{{"cornell", "the Cornell box, with a camera and a point light"}, make_cornell},
    Entry{{"needles", "3,000 slivers, a trial for voxelizers"}, make_needles},
};

}  // namespace

std::span<const Builtin> builtins() {
    static constexpr auto table = [] {
        std::array<Builtin, entries.size()> all{};
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = entries[i].builtin;
        }
        return all;
    }();
    return table;
}

Scene make_builtin(std::string_view name) {
    std::string names;
    for (const Entry& entry : entries) {
        if (entry.builtin.name == name) {
            Scene scene = entry.make();
            scene.name = fmt::format("builtin:{}", name);
            return scene;
        }
        names += names.empty() ? "" : ", ";
        names += entry.builtin.name;
    }
    throw Error(Fault::usage, fmt::format("builtin:{}", name), "there is no such built-in scene",
                "there are: " + names);
}

}  // namespace cairn::scenes
