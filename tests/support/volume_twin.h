#pragma once

#include <cstdint>
#include <vector>

#include "renderer/produce/volume.h"
#include "renderer/renderer.h"

namespace cairn::test {

/// All finest voxels of a field, as bricks store them, in a root cube.
struct Densities {
    glm::dvec3 origin{0.0};
    double voxel_size = 1.0;
    int root_side = 1;  ///< voxels across the root cube
    glm::ivec3 size{1};
    std::vector<std::uint8_t> voxels;  ///< voxels, x fastest

    /// The density at `p`, in voxels: trilinear between the centres of voxels, in [0, 1].
    [[nodiscard]] double at(const glm::dvec3& p) const;
};
[[nodiscard]] Densities densities_of(const renderer::Field& field, int root_side);

/// The emission that one ray gathers front to back, and the light that is let through, by many small steps in
/// double.
struct Gathered {
    glm::dvec3 color{0.0};
    double transmittance = 1.0;
};
[[nodiscard]] Gathered march_densities(const Densities& densities, const renderer::TransferFunction& transfer,
                                       const glm::dvec3& eye, const glm::dvec3& direction,
                                       double steps_a_voxel);

/// Direction in the world of the ray through a pixel's centre.
[[nodiscard]] glm::dvec3 pixel_direction(const renderer::View& view, int x, int y);

/// The picture of a volume that is lit alike from everywhere.
[[nodiscard]] optics::Image march_densities(const Densities& densities,
                                            const renderer::TransferFunction& transfer,
                                            const renderer::View& view, double steps_a_voxel = 24.0);

}  // namespace cairn::test
