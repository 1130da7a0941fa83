#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/surface.h"

namespace cairn::test {

/// A scene of masked triangles over one texture, in a grid of the unit cube [0, 1]^3.
struct MaskedScene {
    MaskedScene(int width, int height, std::vector<std::uint8_t> alphas, scenes::Wrap s, scenes::Wrap t) {
        scenes::Image& image = scene.images.emplace_back();
        image.width = width;
        image.height = height;
        for (const std::uint8_t alpha : alphas)
            image.rgba.insert(image.rgba.end(), {255, 255, 255, alpha});
        scene.textures.push_back({0, s, t});
        scenes::Material& material = scene.materials.emplace_back();
        material.texture = 0;
        material.alpha_mode = scenes::AlphaMode::mask;
        primitive.material = 0;
    }
    void add(const std::array<glm::vec3, 3>& corners, const std::array<glm::vec2, 3>& texcoords) {
        for (std::size_t i = 0; i < 3; ++i) {
            primitive.indices.push_back(std::uint32_t(primitive.positions.size()));
            primitive.positions.push_back(corners[i]);
            primitive.texcoords.push_back(texcoords[i]);
        }
    }
    [[nodiscard]] voxelizer::Surface surface(int resolution) const {
        scenes::Snapshot snapshot;
        snapshot.items.push_back({&primitive, primitive.positions, {}, glm::dmat4(1.0)});
        return voxelizer::build_surface(scene, snapshot,
                                        {glm::dvec3(0.0), 1.0 / resolution, glm::ivec3(resolution)});
    }
    scenes::Scene scene;
    scenes::Primitive primitive;
};

}  // namespace cairn::test
