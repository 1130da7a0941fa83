#include <cmath>
#include <numbers>

#include "scenes/builtin/generators.h"

namespace cairn::scenes {
namespace {

constexpr std::uint32_t sections =
    828;  // times sides times 2: the 52,992 triangles of Forest et al. 2009, Figure 5b
constexpr std::uint32_t sides = 32;
constexpr double torus_radius = 1.0;
constexpr double winding_radius = 0.45;
constexpr double tube_radius = 0.2;

/// The (2, 3) torus knot. The normal of the torus is square to the curve everywhere, and closes with it: a
/// frame for the tube that neither twists nor degenerates, as a Frenet frame might.
struct KnotFrame {
    glm::dvec3 center, normal, binormal;
};

KnotFrame frame_at(double angle) {
    const double around = 2.0 * angle;
    const double winding = 3.0 * angle;
    const glm::dvec3 outward(std::cos(around), std::sin(around), 0.0);
    const glm::dvec3 forward(-outward.y, outward.x, 0.0);
    const glm::dvec3 axis(0.0, 0.0, 1.0);
    const double reach = torus_radius + winding_radius * std::cos(winding);

    KnotFrame frame;
    frame.center = reach * outward + winding_radius * std::sin(winding) * axis;
    frame.normal = std::cos(winding) * outward + std::sin(winding) * axis;
    const glm::dvec3 tangent =
        2.0 * reach * forward +
        3.0 * winding_radius * (std::cos(winding) * axis - std::sin(winding) * outward);
    frame.binormal = glm::normalize(glm::cross(tangent, frame.normal));
    return frame;
}

}  // namespace

Scene make_knot() {
    constexpr double turn = 2.0 * std::numbers::pi;
    Scene scene;
    Primitive tube;
    tube.material = add_material(scene, "brass", {0.75F, 0.45F, 0.15F});
    for (std::uint32_t section = 0; section < sections; ++section) {
        const KnotFrame frame = frame_at(turn * section / sections);
        for (std::uint32_t side = 0; side < sides; ++side) {
            const double angle = turn * side / sides;
            const glm::dvec3 normal = std::cos(angle) * frame.normal + std::sin(angle) * frame.binormal;
            tube.positions.emplace_back(frame.center + tube_radius * normal);
            tube.normals.emplace_back(normal);

            const std::uint32_t next_section = (section + 1) % sections * sides;
            const std::uint32_t next_side = (side + 1) % sides;
            const std::uint32_t a = section * sides + side;
            const std::uint32_t b = section * sides + next_side;
            const std::uint32_t c = next_section + next_side;
            const std::uint32_t d = next_section + side;
            tube.indices.insert(tube.indices.end(), {a, b, c, a, c, d});
        }
    }
    const int mesh = add_mesh(scene, "trefoil tube", std::move(tube));
    scene.scenes.push_back({"knot", {add_node(scene, "knot", mesh)}});
    return scene;
}

}  // namespace cairn::scenes
