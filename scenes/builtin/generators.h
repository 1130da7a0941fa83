#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <utility>

#include "scenes/scene.h"

/// The generators behind make_builtin(), one per file, and the few steps that they share.
namespace cairn::scenes {

enum class Leaves { triangles, masked_cards };

[[nodiscard]] Scene make_knot();
[[nodiscard]] Scene make_spheres();
[[nodiscard]] Scene make_tree(Leaves leaves);
[[nodiscard]] Scene make_cornell();
[[nodiscard]] Scene make_needles();

/// A stream of numbers that is the same with every standard library: the outputs of std::mt19937 are
/// prescribed, those of the std distributions are not.
class RandomStream {
public:
    explicit RandomStream(std::uint32_t seed) : bits_(seed) {}

    /// A number in [0, 1), a multiple of 2^-24.
    [[nodiscard]] double unit() { return static_cast<double>(bits_() >> 8) * 0x1p-24; }
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * unit(); }

private:
    std::mt19937 bits_;
};

/// Adds a material of one colour; returns its index.
inline int add_material(Scene& scene, std::string name, const glm::vec3& linear_color) {
    Material material;
    material.name = std::move(name);
    material.base_color = glm::vec4(linear_color, 1.0F);
    scene.materials.push_back(std::move(material));
    return static_cast<int>(scene.materials.size()) - 1;
}

/// Adds a mesh of one primitive; returns its index.
inline int add_mesh(Scene& scene, std::string name, Primitive primitive) {
    Mesh mesh;
    mesh.name = std::move(name);
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
}

/// Adds a node without a parent that draws a mesh (-1: no mesh) at a place; returns its index.
inline int add_node(Scene& scene, std::string name, int mesh, const glm::dvec3& translation = {}) {
    Node node;
    node.name = std::move(name);
    node.mesh = mesh;
    node.trs.translation = translation;
    scene.nodes.push_back(std::move(node));
    return static_cast<int>(scene.nodes.size()) - 1;
}

}  // namespace cairn::scenes
