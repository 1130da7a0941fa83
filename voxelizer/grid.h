#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "scenes/snapshot.h"

namespace cairn::voxelizer {

/// log2 of the lattice units across a root cube (LATTICE_BITS in the shaders).
constexpr int lattice_bits = 24;
/// The lattice units from a grid's origin, along each axis, that a vertex may be away: 2^40
/// (LATTICE_WORLD_LIMIT in the shaders).
constexpr double lattice_world_limit = 0x1p40;

/// Where voxels lie in the world: voxel (i, j, k) is the closed box from origin + (i, j, k) * voxel_size to
/// origin + (i+1, j+1, k+1) * voxel_size. World to grid is a uniform scale and a translation.
///
/// The grid is the low corner of its *root cube*, whose side is the next power of two of voxels. The root
/// cube carries the *lattice*: 2^24 units per axis. A vertex is rounded once to the lattice, and the rounded
/// triangle is the triangle (docs/decisions/voxelizing.md). So voxel planes are whole lattice numbers at
/// every level, whatever the resolution.
struct Grid {
    glm::dvec3 origin{0.0};
    double voxel_size = 1.0;
    glm::ivec3 resolution{0};  ///< voxels along x, y, z; each in [1, 2^24]

    /// The root cube is 2^level voxels along each side: the smallest that holds the longest axis.
    [[nodiscard]] int level() const;
    /// Side of a lattice unit in the world.
    [[nodiscard]] double lattice_unit() const;
    /// Lattice units per world unit: what lattice_from_world multiplies by. A product, because a quotient of
    /// doubles is not rounded alike by all drivers, and shaders/voxelize/deform.comp.glsl must agree.
    [[nodiscard]] double lattice_scale() const;
    /// Nearest lattice point, floor((world - origin) * lattice_scale() + 1/2); not limited to the root cube.
    /// @throws Error (Fault::input) past +-lattice_world_limit units.
    [[nodiscard]] glm::i64vec3 lattice_from_world(const glm::dvec3& world) const;
};

/// The default grid: around the bounds, centred, with the least voxels that leave one empty on each side of
/// every axis (none along an axis of resolution < 3). So a cube's longest axis decides. Empty bounds give a
/// grid at the world's origin whose longest axis is 1; a point, such a grid around it.
[[nodiscard]] Grid grid_around(const scenes::Bounds& bounds, const glm::ivec3& resolution);
[[nodiscard]] inline Grid grid_around(const scenes::Bounds& bounds, int resolution) {
    return grid_around(bounds, glm::ivec3(resolution));
}

/// A grid over given bounds : low corner kept, with the least voxels that cover the bounds along
/// every axis. So a cube's side is the longest axis.
[[nodiscard]] Grid grid_over(const scenes::Bounds& bounds, const glm::ivec3& resolution);
[[nodiscard]] inline Grid grid_over(const scenes::Bounds& bounds, int resolution) {
    return grid_over(bounds, glm::ivec3(resolution));
}

constexpr int MAX_GRID_RESOLUTION = 1 << lattice_bits;

/// Voxels of a given size , as many as it takes to leave one empty on each side of every
/// axis; centred. Empty bounds give one voxel at the world's origin.
/// @param voxel_size  world units, above 0
/// @param limit       the most voxels along an axis
/// @throws Error      Fault::usage past the limit; says which size would fit.
[[nodiscard]] Grid grid_of_voxels_around(const scenes::Bounds& bounds, double voxel_size,
                                         int limit = MAX_GRID_RESOLUTION);

/// The same over given bounds: low corner kept, no voxel left empty, so that parts of a world which are cut
/// with one size meet without a seam.
[[nodiscard]] Grid grid_of_voxels_over(const scenes::Bounds& bounds, double voxel_size,
                                       int limit = MAX_GRID_RESOLUTION);

/// A box of voxels at one level of a root cube: voxel side 2^(24 - level) lattice units, 2^level voxels
/// across the cube. May reach outside the cube (a brick's border does).
struct Region {
    int level = 0;
    glm::ivec3 origin{0};
    glm::ivec3 size{0};

    /// Lattice units along the side of a voxel.
    [[nodiscard]] int voxel_side() const { return 1 << (lattice_bits - level); }
};

/// All voxels of a grid.
[[nodiscard]] Region whole(const Grid& grid);

}  // namespace cairn::voxelizer
