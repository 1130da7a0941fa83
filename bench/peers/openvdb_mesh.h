#pragma once

#include <array>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"

namespace cairn::bench {

/// OpenVDB's meshToVolume, the tool that users of volumes have at hand. It computes distances, so a voxel
/// counts as occupied if its centre is within half a voxel's diagonal of the surface. This is the least
/// radius that misses no voxel; it marks about 15% too many on a smooth surface.
class OpenVdbMesh {
public:
    /// @param points     vertices in voxels; voxel i spans [i, i + 1]
    /// @param triangles  indices into `points`
    OpenVdbMesh(const std::vector<glm::vec3>& points, const std::vector<glm::uvec3>& triangles);

    /// Computes unsigned distances in the narrowest band that the library keeps.
    /// @param voxels  receives the occupied voxels of its own size from voxel 0 on, if not null.
    /// @return        milliseconds of the conversion alone, on all cores
    double convert(voxelizer::BitGrid* voxels) const;

private:
    struct Mesh;
    std::shared_ptr<const Mesh> mesh_;
};

}  // namespace cairn::bench
