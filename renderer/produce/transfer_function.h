#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

namespace cairn::renderer {

/// Densities that a brick tells apart, from 0 to 1 (DENSITY_STEPS in the shaders).
constexpr int density_steps = 256;
/// The most that VolumeOptions::steps_per_voxel can be (VOLUME_MOST_STEPS in the shaders).
constexpr int volume_most_steps = 32;

/// What one density looks like.
struct ControlPoint {
    double value = 0.0;       ///< density, in [0, 1]
    glm::dvec3 color{1.0};    ///< linear, each in [0, 1]
    double extinction = 0.0;  ///< a world unit of it lets exp(-extinction) of the light through; at least 0
};

/// From density to colour and extinction: linear between control points, and constant before the first and
/// behind the last. It is read at the 256 densities that a brick stores, and is linear between those.
class TransferFunction {
public:
    /// @param points  at least one, in ascending order; two of one value make a jump, which is then as wide
    /// as the
    ///                distance of two densities that a brick tells apart.
    /// @throws Error (Fault::usage) where they are not, or are out of range.
    explicit TransferFunction(const std::vector<ControlPoint>& points);

    /// rgb: emission, which is colour times extinction; a: extinction. Both a world unit.
    [[nodiscard]] glm::dvec4 optics(double density) const;
    /// Mean of optics() while the density goes evenly from one value to the other.
    [[nodiscard]] glm::dvec4 mean_optics(int from, int to) const;
    /// Which of the stored densities have an extinction.
    [[nodiscard]] std::array<bool, density_steps> visible() const;

private:
    std::array<glm::dvec4, density_steps> optics_{};
    std::array<glm::dvec4, density_steps> integral_{};  // from density 0 to each
};

/// How rays go through a volume.
struct VolumeOptions {
    int steps_per_voxel = 2;  ///< of a voxel's chord, [1, volume_most_steps]
    double full_gradient =
        0.08;  ///< densities a voxel: so steep, a place is lit as a surface; 0: lit as fog everywhere
    /// Voxels of the level that is seen: a shadow ray leaves out so much of the volume next to where it
    /// starts, which would darken what is steep by itself.
    double shadow_start = 2.0;
};

}  // namespace cairn::renderer
