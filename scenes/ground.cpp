#include "scenes/ground.h"

#include <algorithm>
#include <utility>

namespace cairn::scenes {

void add_ground(Scene& scene, const Bounds& bounds, std::optional<int> scene_index) {
    if (bounds.empty()) return;
    const glm::dvec3 extent = bounds.high - bounds.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    Material white;
    white.name = "ground";
    white.double_sided = true;
    Primitive square;
    square.material = int(scene.materials.size());
    square.positions = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    square.normals.assign(4, {0, 1, 0});
    square.indices = {0, 1, 2, 0, 2, 3};
    Mesh mesh;
    mesh.name = "ground";
    mesh.primitives.push_back(std::move(square));
    Node node;
    node.name = "ground";
    node.mesh = int(scene.meshes.size());
    node.trs.translation = 0.5 * (bounds.low + bounds.high);
    node.trs.translation.y = bounds.low.y - 1e-3 * longest;
    node.trs.scale = glm::dvec3(longest);
    const auto described = std::size_t(scene_index.value_or(scene.default_scene));
    scene.scenes[described].nodes.push_back(int(scene.nodes.size()));
    scene.materials.push_back(std::move(white));
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(std::move(node));
}

}  // namespace cairn::scenes
