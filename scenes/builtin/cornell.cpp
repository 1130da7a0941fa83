#include <cmath>
#include <span>

#include "scenes/builtin/generators.h"

// The Cornell box as measured by the Cornell University Program of Computer Graphics ("Cornell Box Data",
// 1998). Positions are the published ones; colours are the usual RGB stand-ins for the published spectra.

namespace cairn::scenes {
namespace {

struct Quad {
    glm::dvec3 corners[4];
};

const Quad floor_quad = {{{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}};
const Quad ceiling = {{{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}};
const Quad back_wall = {{{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}};
const Quad right_wall = {{{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}};
const Quad left_wall = {{{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}};
const Quad short_block[] = {
    {{{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}},
    {{{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}},
    {{{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}},
    {{{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}},
    {{{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}},
};
const Quad tall_block[] = {
    {{{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}},
    {{{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}},
    {{{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}},
    {{{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}},
    {{{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}},
};
// The panel hangs half a unit under the ceiling, in whose plane it is published: else the two fight for one
// depth.
const Quad light_panel = {{{343, 548.3, 227}, {343, 548.3, 332}, {213, 548.3, 332}, {213, 548.3, 227}}};
const glm::dvec3 light_place = {278, 500, 279.5};  ///< far enough from the panel to be outside its voxels
const glm::dvec3 camera_place = {278, 273, -800};

/// Published units to metres (a hundred to one), centred, and turned so that the camera looks along -Z as in
/// glTF.
glm::dvec3 world_from_published(const glm::dvec3& point) {
    const glm::dvec3 centered = (point - glm::dvec3(278.0, 274.4, 279.6)) / 100.0;
    return {-centered.x, centered.y, -centered.z};
}

Primitive make_quads(std::span<const Quad> quads, int material) {
    Primitive primitive;
    primitive.material = material;
    for (const Quad& quad : quads) {
        glm::dvec3 corners[4];
        for (int i = 0; i < 4; ++i) {
            corners[i] = world_from_published(quad.corners[i]);
        }
        const glm::vec3 normal(glm::normalize(glm::cross(corners[1] - corners[0], corners[3] - corners[0])));
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        for (const glm::dvec3& corner : corners) {
            primitive.positions.emplace_back(corner);
            primitive.normals.push_back(normal);
        }
        primitive.indices.insert(primitive.indices.end(),
                                 {first, first + 1, first + 2, first, first + 2, first + 3});
    }
    return primitive;
}

}  // namespace

Scene make_cornell() {
    Scene scene;
    const int white = add_material(scene, "white", {0.73F, 0.73F, 0.73F});
    const int red = add_material(scene, "red", {0.65F, 0.05F, 0.05F});
    const int green = add_material(scene, "green", {0.12F, 0.45F, 0.15F});
    const int panel = add_material(scene, "light panel", {1.0F, 0.95F, 0.85F});

    const int root = add_node(scene, "cornell box", -1);
    const auto add_child = [&](int node) { scene.nodes[root].children.push_back(node); };
    const Quad white_walls[] = {floor_quad, ceiling, back_wall};
    const int box = add_mesh(scene, "walls", make_quads(white_walls, white));
    scene.meshes[box].primitives.push_back(make_quads({&left_wall, 1}, red));
    scene.meshes[box].primitives.push_back(make_quads({&right_wall, 1}, green));
    add_child(add_node(scene, "walls", box));
    add_child(add_node(scene, "short block", add_mesh(scene, "short block", make_quads(short_block, white))));
    add_child(add_node(scene, "tall block", add_mesh(scene, "tall block", make_quads(tall_block, white))));
    add_child(
        add_node(scene, "light panel", add_mesh(scene, "light panel", make_quads({&light_panel, 1}, panel))));

    Light light;
    light.name = "light";
    light.color = {1.0F, 0.9F, 0.75F};
    light.intensity = 10.0F;
    scene.lights.push_back(light);
    const int light_node = add_node(scene, "light", -1, world_from_published(light_place));
    scene.nodes[light_node].light = 0;
    add_child(light_node);

    Camera camera;
    camera.name = "camera";
    camera.yfov = 2.0 * std::atan2(0.025 / 2.0, 0.035);  // a 25 mm square film behind a lens of 35 mm
    camera.znear = 0.1;
    scene.cameras.push_back(camera);
    const int camera_node = add_node(scene, "camera", -1, world_from_published(camera_place));
    scene.nodes[camera_node].camera = 0;
    add_child(camera_node);

    scene.scenes.push_back({"cornell", {root}});
    return scene;
}

}  // namespace cairn::scenes
