#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "renderer/renderer.h"
#include "scenes/scene.h"
#include "voxelizer/grid.h"

/// The renderer's twin: the same picture from one dense grid on the CPU, in double, without tree, bricks,
/// masks and passes. Plain code, which shares only the definitions with the renderer.
namespace cairn::test {

/// The unit normals that represent all normals in a voxel, with the precision of the pool's texels.
struct TwoNormals {
    bool there = false;
    glm::dvec3 first{0.0};
    glm::dvec3 second{0.0};
    double share = 0.0;  ///< share of the second normal
};

/// The content of bricks for every voxel of the root cube, with the precision of the pool's texels.
struct DenseVoxels {
    voxelizer::Grid grid;
    int side = 0;
    std::vector<double> coverage;  ///< coverage in [0, 1]
    std::vector<TwoNormals> normals;

    [[nodiscard]] std::size_t index(const glm::ivec3& v) const {
        return (std::size_t(v.z) * std::size_t(side) + std::size_t(v.y)) * std::size_t(side) +
               std::size_t(v.x);
    }
};

/// Makes the voxels of a white scene with flat normals from exact voxels (by the reference) of each triangle
/// alone, four times finer.
[[nodiscard]] DenseVoxels dense_voxels(const scenes::Scene& scene, int resolution);

/// Marches the dense grid at its own resolution, whatever the distance.
[[nodiscard]] optics::Image march_dense(const DenseVoxels& voxels, const renderer::View& view);

}  // namespace cairn::test
