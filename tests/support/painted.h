#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/scene.h"
#include "scenes/snapshot.h"
#include "tests/support/attribute_truth.h"
#include "tests/support/lattice_surface.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

/// Surfaces with colours, for what gathers attributes and for the integral that it is compared with.
namespace cairn::test {

/// A primitive of one material in a grid of the unit cube, for the voxelizer and for the truth.
struct Painted {
    scenes::Scene scene;
    scenes::Primitive primitive;
    bool with_normals = true;

    Painted() {
        scene.materials.emplace_back();
        primitive.material = 0;
    }
    void use_image(int width, int height, std::vector<std::uint8_t> rgba, scenes::AlphaMode mode) {
        scenes::Image& image = scene.images.emplace_back();
        image.width = width;
        image.height = height;
        image.rgba = std::move(rgba);
        scene.textures.push_back({0, scenes::Wrap::repeat, scenes::Wrap::repeat});
        scene.materials[0].texture = 0;
        scene.materials[0].alpha_mode = mode;
    }
    void add_vertex(const glm::vec3& position, const glm::vec3& normal, const glm::u8vec3& color,
                    const glm::vec2& texcoord) {
        primitive.indices.push_back(std::uint32_t(primitive.positions.size()));
        primitive.positions.push_back(position);
        if (with_normals) primitive.normals.push_back(normal);
        primitive.colors.emplace_back(glm::u16vec3(color) * std::uint16_t(257), 65535);
        primitive.texcoords.push_back(texcoord);
    }
    void reverse() {
        std::vector<std::uint32_t> turned;
        for (std::size_t i = primitive.indices.size(); i >= 3; i -= 3)
            for (std::size_t corner = 3; corner > 0; --corner)
                turned.push_back(primitive.indices[i - corner]);
        primitive.indices = turned;
    }

    [[nodiscard]] voxelizer::Surface surface(const voxelizer::Grid& grid) const {
        scenes::Snapshot snapshot;
        snapshot.items.push_back({&primitive, primitive.positions, primitive.normals, glm::dmat4(1.0)});
        return voxelizer::build_surface(scene, snapshot, grid, {.attributes = true});
    }
    [[nodiscard]] std::vector<TruthTriangle> truth(const voxelizer::Grid& grid) const {
        std::vector<TruthTriangle> out;
        for (std::size_t i = 0; i + 3 <= primitive.indices.size(); i += 3) {
            TruthTriangle& triangle = out.emplace_back();
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t v = primitive.indices[i + corner];
                triangle.corners.push_back(
                    {(glm::dvec3(primitive.positions[v]) - grid.origin) / grid.voxel_size,
                     with_normals ? glm::dvec3(primitive.normals[v]) : glm::dvec3(0.0),
                     glm::dvec3(primitive.colors[v]) / 65535.0, glm::dvec2(primitive.texcoords[v])});
            }
            if (!with_normals) {
                const auto& c = triangle.corners;
                const glm::dvec3 normal =
                    glm::normalize(glm::cross(c[1].position - c[0].position, c[2].position - c[0].position));
                for (TruthVertex& vertex : triangle.corners)
                    vertex.normal = normal;
            }
            const scenes::Material& material = scene.materials[0];
            triangle.image = scene.images.empty() ? nullptr : &scene.images[0];
            triangle.factor = glm::dvec3(material.base_color);
            triangle.masked = material.alpha_mode == scenes::AlphaMode::mask;
        }
        return out;
    }
};

inline voxelizer::Grid unit_cube(int resolution) {
    return {glm::dvec3(0.0), 1.0 / resolution, glm::ivec3(resolution)};
}

/// Triangles of 1 to 20 voxels at a resolution of 32, whose neighbours' normals and colours differ.
inline Painted random_triangles(std::uint32_t seed, int count, bool with_normals) {
    Random random(seed);
    Painted painted;
    painted.with_normals = with_normals;
    const auto unit = [&] { return float(random.unit()); };
    const auto point = [&] {
        const float x = unit();
        const float y = unit();
        return glm::vec3(x, y, unit());
    };
    for (int i = 0; i < count; ++i) {
        const glm::vec3 middle = point();
        const float size = 0.6F * unit() * unit();
        const glm::vec3 normal = glm::normalize(point() - 0.5F);
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 position = middle + size * (point() - 0.5F);
            const glm::vec3 vertex_normal = glm::normalize(normal + 0.3F * (point() - 0.5F));
            const glm::vec3 color = 255.0F * point();
            const glm::vec2 texcoord = 2.0F * glm::vec2(point()) - 0.5F;
            painted.add_vertex(position, vertex_normal, glm::u8vec3(color), texcoord);
        }
    }
    return painted;
}

/// Neighbouring texels differ little, so that a mean over samples is as good as the integral.
inline std::vector<std::uint8_t> smooth_image(int side) {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto wave = [&](int at) { return std::uint8_t(90 + 80 * std::sin(6.2831853 * at / side)); };
            rgba.insert(rgba.end(), {wave(x), wave(y), 120, 255});
        }
    }
    return rgba;
}

}  // namespace cairn::test
