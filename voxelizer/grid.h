#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "scenes/snapshot.h"

namespace cairn::voxelizer {

/// log2 of the lattice units across a root cube (LATTICE_BITS in the shaders).
constexpr int lattice_bits = 24;
/// Greatest distance of a vertex from a grid's origin along an axis, in lattice units: 2^40
/// (LATTICE_WORLD_LIMIT in the shaders).
constexpr double lattice_world_limit = 0x1p40;

/// Places voxels in the world: voxel (i, j, k) is the closed box from origin + (i, j, k) * voxel_size to
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
    /// Lattice units per world unit, by which lattice_from_world multiplies. It does not divide, because
    /// drivers do not round quotients of doubles alike, and shaders/voxelize/deform.comp.glsl must give the
    /// same result.
    [[nodiscard]] double lattice_scale() const;
    /// Nearest lattice point, floor((world - origin) * lattice_scale() + 1/2); not limited to the root cube.
    /// @throws Error (Fault::usage)  if the point lies further than lattice_world_limit units away.
    /// @throws Error (Fault::input)  if it is not finite.
    [[nodiscard]] glm::i64vec3 lattice_from_world(const glm::dvec3& world) const;
};

/// The default grid: centred around the bounds, with the smallest voxels of which one stays empty on each
/// side of every axis (none along an axis of resolution < 3). So a cube's longest axis decides. Empty bounds
/// give a grid at the world's origin whose longest axis is 1; bounds that are a point, such a grid around the
/// point.
[[nodiscard]] Grid grid_around(const scenes::Bounds& bounds, const glm::ivec3& resolution);
[[nodiscard]] inline Grid grid_around(const scenes::Bounds& bounds, int resolution) {
    return grid_around(bounds, glm::ivec3(resolution));
}

/// A grid over given bounds: the low corner is kept, and voxels are the smallest that cover the bounds along
/// every axis. So a cube's side is the longest axis.
[[nodiscard]] Grid grid_over(const scenes::Bounds& bounds, const glm::ivec3& resolution);
[[nodiscard]] inline Grid grid_over(const scenes::Bounds& bounds, int resolution) {
    return grid_over(bounds, glm::ivec3(resolution));
}

constexpr int MAX_GRID_RESOLUTION = 1 << lattice_bits;

/// A grid of voxels of a given size, centred around the bounds: as few voxels as leave one empty on each side
/// of every axis. Empty bounds give one voxel at the world's origin.
/// @param voxel_size  world units, above 0
/// @param limit       greatest number of voxels along an axis
/// @throws Error      Fault::usage past the limit; the message says which size would fit.
[[nodiscard]] Grid grid_of_voxels_around(const scenes::Bounds& bounds, double voxel_size,
                                         int limit = MAX_GRID_RESOLUTION);

/// A grid of voxels of a given size over given bounds: the low corner is kept, and no voxel is left empty
/// around them, so that parts of a world that are cut with one size meet without a seam.
[[nodiscard]] Grid grid_of_voxels_over(const scenes::Bounds& bounds, double voxel_size,
                                       int limit = MAX_GRID_RESOLUTION);

/// A box of voxels at one level of a root cube: voxel side 2^(24 - level) lattice units, 2^level voxels
/// across the cube. A region may reach out of the cube, as a brick's border does.
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
