#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "tests/support/lattice_surface.h"

namespace cairn::test {

/// A chequered texture with holes.
inline scenes::Image holes() {
    scenes::Image image;
    image.width = image.height = 8;
    for (int texel = 0; texel < 64; ++texel) {
        const bool is_hole = (texel + texel / 8) % 2 == 0;
        image.rgba.insert(image.rgba.end(),
                          {std::uint8_t(4 * texel), 99, 200, std::uint8_t(is_hole ? 0 : 255)});
    }
    return image;
}

/// Triangles from less than a voxel to the whole unit cube; textured, so that a mask may cut them.
inline void add_triangles(scenes::Primitive& primitive, Random& random, int count) {
    const auto unit = [&] { return float(random.unit()); };
    for (int i = 0; i < count; ++i) {
        const float size = i % 7 == 0 ? 1.0F : 0.2F * unit();
        const glm::vec3 low = (1.0F - size) * glm::vec3(unit(), unit(), unit());
        for (int corner = 0; corner < 3; ++corner) {
            primitive.indices.push_back(std::uint32_t(primitive.positions.size()));
            primitive.positions.push_back(low + size * glm::vec3(unit(), unit(), unit()));
            primitive.normals.push_back(glm::normalize(glm::vec3(unit(), unit(), 0.1F)));
            primitive.texcoords.emplace_back(3.0F * unit(), 3.0F * unit());
            primitive.colors.emplace_back(65535.0F * glm::vec3(unit(), unit(), unit()), 65535);
        }
    }
}

/// 120 masked and opaque triangles, five of each in turn, so that most small batches hold both.
inline scenes::Scene mixed_scene(std::uint32_t seed) {
    Random random(seed);
    scenes::Scene scene;
    scene.images.push_back(holes());
    scene.textures.push_back({0, scenes::Wrap::repeat, scenes::Wrap::repeat});
    scene.materials.resize(2);
    scene.materials[1].texture = 0;
    scene.materials[1].alpha_mode = scenes::AlphaMode::mask;
    scenes::Mesh& mesh = scene.meshes.emplace_back();
    for (int number = 0; number < 24; ++number) {
        scenes::Primitive& primitive = mesh.primitives.emplace_back();
        primitive.material = number % 2;
        add_triangles(primitive, random, 5);
    }
    scene.nodes.emplace_back().mesh = 0;
    scene.scenes.push_back({"", {0}});
    return scene;
}

}  // namespace cairn::test
