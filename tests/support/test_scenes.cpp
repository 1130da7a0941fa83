#include "tests/support/test_scenes.h"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace cairn::test {
namespace {

using glm::vec3;

void add_square(std::vector<vec3>& corners, float half, float y) {
    const vec3 a(-half, y, -half);
    const vec3 b(-half, y, half);
    const vec3 c(half, y, half);
    const vec3 d(half, y, -half);
    corners.insert(corners.end(), {a, b, c, a, c, d});
}

void add_ball_patch(std::vector<vec3>& corners, vec3 a, vec3 b, vec3 c, int depth) {
    if (depth == 0) {
        corners.insert(corners.end(), {a, b, c});
        return;
    }
    const vec3 ab = glm::normalize(a + b);
    const vec3 bc = glm::normalize(b + c);
    const vec3 ca = glm::normalize(c + a);
    add_ball_patch(corners, a, ab, ca, depth - 1);
    add_ball_patch(corners, ab, b, bc, depth - 1);
    add_ball_patch(corners, ca, bc, c, depth - 1);
    add_ball_patch(corners, ab, bc, ca, depth - 1);
}

}  // namespace

scenes::Scene triangles(std::vector<vec3> corners) {
    scenes::Scene scene;
    scenes::Primitive primitive;
    primitive.indices.resize(corners.size());
    std::iota(primitive.indices.begin(), primitive.indices.end(), 0U);
    primitive.positions = std::move(corners);
    scenes::Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    scene.meshes.push_back(std::move(mesh));
    scenes::Node node;
    node.mesh = 0;
    scene.nodes.push_back(std::move(node));
    scene.scenes.push_back({"", {0}});
    return scene;
}

scenes::Scene ball_over_floor() {
    // An icosahedron (Euclid's golden rectangles), each side divided in 16.
    const float g = 0.5F * (1.0F + std::sqrt(5.0F));
    std::array<vec3, 12> p = {vec3(-1, g, 0), vec3(1, g, 0), vec3(-1, -g, 0), vec3(1, -g, 0),
                              vec3(0, -1, g), vec3(0, 1, g), vec3(0, -1, -g), vec3(0, 1, -g),
                              vec3(g, 0, -1), vec3(g, 0, 1), vec3(-g, 0, -1), vec3(-g, 0, 1)};
    for (vec3& v : p)
        v = glm::normalize(v);
    constexpr int sides[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<vec3> corners;
    for (const auto& s : sides)
        add_ball_patch(corners, p[std::size_t(s[0])], p[std::size_t(s[1])], p[std::size_t(s[2])], 2);
    for (vec3& v : corners)
        v.y += 1.3F;
    add_square(corners, 2.0F, 0.0F);
    scenes::Scene scene = triangles(std::move(corners));
    scene.nodes[0].trs.rotation = glm::angleAxis(0.2, glm::normalize(glm::dvec3(0.3, 1.0, 0.6)));
    return scene;
}

scenes::Scene square_over_floor() {
    std::vector<vec3> corners;
    add_square(corners, 2.0F, 0.0F);
    add_square(corners, 0.5F, 1.0F);
    return triangles(std::move(corners));
}

scenes::Scene sheet(const glm::vec4& color) {
    std::vector<vec3> corners;
    add_square(corners, 1.0F, 0.0F);
    scenes::Scene scene = triangles(std::move(corners));
    scenes::Material material;
    material.base_color = color;
    scene.materials.push_back(std::move(material));
    scene.meshes[0].primitives[0].material = 0;
    return scene;
}

}  // namespace cairn::test
