#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"

/// Textures that are finer than what looks at them.
namespace cairn::test {

/// RGBA8 of single texels of two kinds in turn.
inline std::vector<std::uint8_t> checkerboard(int side, const glm::u8vec4& even, const glm::u8vec4& odd) {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < side * side; ++i) {
        const glm::u8vec4& t = (i % side + i / side) % 2 == 0 ? even : odd;
        rgba.insert(rgba.end(), {t.r, t.g, t.b, t.a});
    }
    return rgba;
}

inline const glm::u8vec4 opaque_white(255);
inline const glm::u8vec4 opaque_black(0, 0, 0, 255);
/// What a mask keeps, and what it hides.
inline const glm::u8vec4 kept_green(0, 180, 0, 255);
inline const glm::u8vec4 hidden_magenta(255, 0, 255, 100);

/// Gives a primitive a material with this texture of `side` by `side` texels. Its texture coordinates are the
/// vertices' places along x and z, times `per_length`.
inline void paint_from_above(scenes::Scene& scene, scenes::Primitive& primitive, int side,
                             std::vector<std::uint8_t> rgba, scenes::AlphaMode mode, float per_length) {
    scenes::Image& image = scene.images.emplace_back();
    image.width = side;
    image.height = side;
    image.rgba = std::move(rgba);
    scene.textures.push_back({int(scene.images.size()) - 1, scenes::Wrap::repeat, scenes::Wrap::repeat});
    scenes::Material& material = scene.materials.emplace_back();
    material.texture = int(scene.textures.size()) - 1;
    material.alpha_mode = mode;
    primitive.material = int(scene.materials.size()) - 1;
    primitive.texcoords.clear();
    for (const glm::vec3& position : primitive.positions)
        primitive.texcoords.emplace_back(per_length * position.x, per_length * position.z);
}

}  // namespace cairn::test
