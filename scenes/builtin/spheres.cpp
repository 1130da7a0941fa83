#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scenes/builtin/generators.h"

// "A cubic form composed of 9x9 spheres", 6,848 polygons (Forest et al. 2009, Figure 5a). The paper says no
// more. Here it is nine groups of nine, each a cube's corners and its centre: 80 spheres of 84 triangles, and
// the middle one of 128.

namespace cairn::scenes {
namespace {

constexpr double radius = 0.32;
/// Distance from a group's centre to its spheres, along each axis.
constexpr double spacing = 0.4;
/// Distance from the scene's centre to the groups' centres: three times the spacing within a group, so that
/// no two groups touch.
constexpr double group_spacing = 1.2;

/// A sphere of 2 * segments * (bands - 1) triangles, closed: the poles and the seam are shared vertices.
Primitive make_sphere(std::uint32_t segments, std::uint32_t bands) {
    Primitive sphere;
    const auto add_vertex = [&](const glm::dvec3& normal) {
        sphere.positions.emplace_back(radius * normal);
        sphere.normals.emplace_back(normal);
    };
    add_vertex({0.0, 1.0, 0.0});
    for (std::uint32_t ring = 1; ring < bands; ++ring) {
        const double polar = std::numbers::pi * ring / bands;
        for (std::uint32_t segment = 0; segment < segments; ++segment) {
            const double azimuth = 2.0 * std::numbers::pi * segment / segments;
            add_vertex(
                {std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth)});
        }
    }
    add_vertex({0.0, -1.0, 0.0});

    const std::uint32_t south = static_cast<std::uint32_t>(sphere.positions.size()) - 1;
    const std::uint32_t last_ring = south - segments;
    for (std::uint32_t segment = 0; segment < segments; ++segment) {
        const std::uint32_t next = (segment + 1) % segments;
        sphere.indices.insert(sphere.indices.end(), {0, 1 + segment, 1 + next});
        for (std::uint32_t upper = 1; upper < last_ring; upper += segments) {
            const std::uint32_t lower = upper + segments;
            sphere.indices.insert(sphere.indices.end(), {upper + segment, lower + segment, lower + next});
            sphere.indices.insert(sphere.indices.end(), {upper + segment, lower + next, upper + next});
        }
        sphere.indices.insert(sphere.indices.end(), {last_ring + segment, south, last_ring + next});
    }
    return sphere;
}

/// Direction to the corners of a cube for 0 to 7; for 8, its centre.
glm::dvec3 direction(int place) {
    if (place == 8) return {0.0, 0.0, 0.0};
    return {(place & 1) != 0 ? 1.0 : -1.0, (place & 2) != 0 ? 1.0 : -1.0, (place & 4) != 0 ? 1.0 : -1.0};
}

}  // namespace

Scene make_spheres() {
    Scene scene;
    const int root = add_node(scene, "spheres", -1);
    for (int group = 0; group < 9; ++group) {
        // Each group has the colour of its corner of the RGB cube, and one mesh that its spheres share.
        const glm::vec3 color = glm::vec3(0.44F) + 0.34F * glm::vec3(direction(group));
        Primitive sphere = make_sphere(14, 4);
        sphere.material = add_material(scene, fmt::format("group {}", group), color);
        Primitive middle = make_sphere(16, 5);
        middle.material = sphere.material;
        const int mesh = add_mesh(scene, fmt::format("sphere of group {}", group), std::move(sphere));

        const int group_node =
            add_node(scene, fmt::format("group {}", group), -1, group_spacing * direction(group));
        scene.nodes[root].children.push_back(group_node);
        for (int place = 0; place < 9; ++place) {
            const bool in_the_middle = group == 8 && place == 8;
            const int node = add_node(scene, fmt::format("sphere {}.{}", group, place),
                                      in_the_middle ? add_mesh(scene, "middle sphere", middle) : mesh,
                                      spacing * direction(place));
            scene.nodes[group_node].children.push_back(node);
        }
    }
    scene.scenes.push_back({"spheres", {root}});
    return scene;
}

}  // namespace cairn::scenes
