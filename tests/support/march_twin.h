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

/// Two planes that hold the surface in a voxel: dot(normal, p) is between `low` and `high`, p in sides of the
/// voxel from its centre.
struct TwinSlab {
    bool there = false;
    bool is_enough = false;  ///< the finer voxels tell no more
    glm::dvec3 normal{0.0};
    double low = 0.0;
    double high = 0.0;
};

/// The content of bricks for every voxel of the root cube, with the precision of the pool's texels.
struct DenseVoxels {
    voxelizer::Grid grid;
    int side = 0;
    /// Finer voxels along each axis of a voxel, which rays meet in its place: 4, or 1 if N = 3.
    int marks = 4;
    std::vector<bool> marked;      ///< (side * marks)^3 finer voxels; empty if marks = 1
    std::vector<double> coverage;  ///< coverage in [0, 1]
    std::vector<TwoNormals> normals;
    std::vector<TwinSlab> slabs;  ///< as many, if there are marks

    [[nodiscard]] std::size_t index(const glm::ivec3& v) const {
        return (std::size_t(v.z) * std::size_t(side) + std::size_t(v.y)) * std::size_t(side) +
               std::size_t(v.x);
    }
    [[nodiscard]] std::size_t mark_index(const glm::ivec3& v) const {
        const auto across = std::size_t(side) * std::size_t(marks);
        return (std::size_t(v.z) * across + std::size_t(v.y)) * across + std::size_t(v.x);
    }
    /// Whether rays meet a finer voxel, as far as the slab allows.
    [[nodiscard]] bool is_marked(const glm::ivec3& v) const {
        return slabs[index(v / marks)].is_enough || marked[mark_index(v)];
    }
};

/// Makes the voxels of a white scene with flat normals from exact voxels (by the reference) of each triangle
/// alone, four times finer.
/// @param has_marks  whether rays meet the finer voxels.
[[nodiscard]] DenseVoxels dense_voxels(const scenes::Scene& scene, int resolution, bool has_marks = true);

/// Marches the dense grid at its own resolution, whatever the distance.
[[nodiscard]] optics::Image march_dense(const DenseVoxels& voxels, const renderer::View& view);

}  // namespace cairn::test
