#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

/// Volumes: a field of densities, and how its densities look.
namespace cairn::renderer {

/// How a field is cut into voxels. A voxel of coarseness c is a cube of n^c finest voxels per side; voxel
/// (i, j, k) of any coarseness starts at i, j, k times its side.
struct FieldFrame {
    int n = 4;                ///< must be the tree's
    glm::dvec3 origin{0.0};   ///< low corner of voxel (0, 0, 0), world
    double voxel_size = 1.0;  ///< side of the finest voxels, world units
    glm::i64vec3 size{1};     ///< finest voxels along each axis; the density beyond is 0
};

/// Bounds of densities. Neither needs to be reached.
struct FieldRange {
    float low = 0.0F;
    float high = 0.0F;
};

/// A density in [0, 1] everywhere, at all levels of detail. Bricks are filled from it, and it reports what is
/// empty (Crassin et al. 2008, section 6.2: explicit volumes, procedural ones, amplified ones).
///
/// Several threads may call its functions at once.
class Field {
public:
    Field() = default;
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;
    Field(Field&&) = delete;
    Field& operator=(Field&&) = delete;
    virtual ~Field() = default;

    [[nodiscard]] virtual const FieldFrame& frame() const = 0;

    /// Writes the mean density of each of count.x * count.y * count.z voxels from `low` on, x fastest.
    /// @param low  in voxels of the coarseness; may lie outside the field.
    virtual void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
                      float* values) const = 0;

    /// Conservative bounds of a box: they hold what fill() gives for any voxel, of any coarseness, that lies
    /// in the box.
    /// @param low, high  in finest voxels; high is the first voxel outside the box.
    [[nodiscard]] virtual FieldRange range(const glm::i64vec3& low, const glm::i64vec3& high) const = 0;
};

/// Densities that a brick distinguishes, from 0 to 1 (DENSITY_STEPS in the shaders).
constexpr int density_steps = 256;
/// The most that VolumeOptions::steps_per_voxel can be (VOLUME_MOST_STEPS in the shaders).
constexpr int volume_most_steps = 32;

/// What one density looks like.
struct ControlPoint {
    double value = 0.0;     ///< density, in [0, 1]
    glm::dvec3 color{1.0};  ///< linear, each in [0, 1]
    /// Per world unit, at least 0: a world unit of the density lets exp(-extinction) of the light through.
    double extinction = 0.0;
};

/// From density to colour and extinction: linear between control points, and constant before the first and
/// behind the last. It is read at the 256 densities that a brick stores, and is linear between those.
class TransferFunction {
public:
    /// @param points  at least one, in ascending order. Two points of one value make a jump, which is as wide
    ///                as the distance of two densities that a brick distinguishes.
    /// @throws Error (Fault::usage) if there is no point, if the points are not in ascending order, or if a
    ///                point is out of range.
    explicit TransferFunction(const std::vector<ControlPoint>& points);

    /// rgb: emission, which is colour times extinction; a: extinction. Both are per world unit.
    [[nodiscard]] glm::dvec4 optics(double density) const;
    /// Mean of optics() while the density goes evenly from one stored density to another.
    [[nodiscard]] glm::dvec4 mean_optics(int from, int to) const;
    /// Marks the stored densities that have an extinction.
    [[nodiscard]] std::array<bool, density_steps> visible() const;

private:
    std::array<glm::dvec4, density_steps> optics_{};
    std::array<glm::dvec4, density_steps> integral_{};  // from density 0 to each
};

/// How rays go through a volume.
struct VolumeOptions {
    /// Steps in which a ray crosses a voxel, in [1, volume_most_steps].
    int steps_per_voxel = 2;
    /// Gradient, in densities per voxel, from which on a place is lit as a surface. 0: everything is lit as
    /// fog.
    double full_gradient = 0.08;
    /// Part of the volume next to its start that a shadow ray leaves out, because steep densities would
    /// darken themselves. In voxels of the level that is seen.
    double shadow_start = 2.0;
};

}  // namespace cairn::renderer
