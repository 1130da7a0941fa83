#include "scenes/builtin/generators.h"

namespace cairn::scenes {

Scene make_needles() {
    constexpr int needle_count = 3000;
    RandomStream random(2009);
    const auto point_in_cube = [&](double half_side) {
        const double x = random.between(-half_side, half_side);
        const double y = random.between(-half_side, half_side);
        return glm::dvec3(x, y, random.between(-half_side, half_side));
    };
    Scene scene;
    Primitive needles;
    needles.material = add_material(scene, "steel", {0.5F, 0.55F, 0.6F});
    for (int needle = 0; needle < needle_count; ++needle) {
        const auto first = static_cast<std::uint32_t>(needles.positions.size());
        const glm::dvec3 point = point_in_cube(1.0);
        needles.positions.emplace_back(point);
        needles.positions.emplace_back(point_in_cube(1.0));
        // Needles are as wide as a fortieth of a voxel of a grid of 256, or one voxel: widths at which a
        // separating-axis test in floats fails.
        needles.positions.emplace_back(point + point_in_cube(needle % 2 == 0 ? 0.0002 : 0.008));
        needles.indices.insert(needles.indices.end(), {first, first + 1, first + 2});
    }
    const int mesh = add_mesh(scene, "needles", std::move(needles));
    scene.scenes.push_back({"needles", {add_node(scene, "needles", mesh)}});
    return scene;
}

}  // namespace cairn::scenes
