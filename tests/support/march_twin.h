#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "renderer/renderer.h"
#include "scenes/scene.h"
#include "voxelizer/grid.h"

/// The renderer's twin: the same picture from one dense grid on the CPU, in double, with no tree, no bricks,
/// no masks and no passes. Plain code that is easy to believe; it shares only the definitions with what it
/// checks.
namespace cairn::test {

/// The unit normals that stand for all those in a voxel, with the bits that the pool's texels keep of them.
struct TwoNormals {
    bool there = false;
    glm::dvec3 first{0.0};
    glm::dvec3 second{0.0};
    double share = 0.0;  ///< of the second
};

/// What bricks hold, for every voxel of the root cube, with the bits that the pool's texels keep of it.
struct DenseVoxels {
    voxelizer::Grid grid;
    int side = 0;
    std::vector<double> coverage;  ///< [0, 1]
    std::vector<TwoNormals> normals;

    [[nodiscard]] std::size_t index(const glm::ivec3& v) const {
        return (std::size_t(v.z) * std::size_t(side) + std::size_t(v.y)) * std::size_t(side) +
               std::size_t(v.x);
    }
};

/// For white scenes with flat normals: exact voxels (by the reference) of each triangle alone, four times
/// finer.
[[nodiscard]] DenseVoxels dense_voxels(const scenes::Scene& scene, int resolution);

/// Marches the dense grid at its own resolution, whatever the distance.
[[nodiscard]] optics::Image march_dense(const DenseVoxels& voxels, const renderer::View& view);

}  // namespace cairn::test
