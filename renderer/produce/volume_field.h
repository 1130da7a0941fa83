#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::renderer {

/// How a field is cut into voxels. A voxel of coarseness c is a cube of n^c finest voxels a side; voxel (i,
/// j, k) of any coarseness starts at i, j, k times its side.
struct FieldFrame {
    int n = 4;                ///< must be the tree's
    glm::dvec3 origin{0.0};   ///< world; low corner of voxel (0, 0, 0)
    double voxel_size = 1.0;  ///< world units; of the finest voxels
    glm::i64vec3 size{1};     ///< finest voxels along each axis; all beyond is density 0
};

/// Bounds of densities, both reached or not.
struct FieldRange {
    float low = 0.0F;
    float high = 0.0F;
};

/// A density in [0, 1] everywhere, known at all levels of detail. What fills bricks and tells what is empty
/// (Crassin et al. 2008, section 6.2: explicit volumes, procedural ones, amplified ones).
///
/// Its functions may be called by several threads at once.
class Field {
public:
    Field() = default;
    Field(const Field&) = delete;
    Field& operator=(const Field&) = delete;
    Field(Field&&) = delete;
    Field& operator=(Field&&) = delete;
    virtual ~Field() = default;

    [[nodiscard]] virtual const FieldFrame& frame() const = 0;

    /// Mean density over each of count.x * count.y * count.z voxels from `low` on, x fastest.
    /// @param low     in voxels of that coarseness; may lie outside the field.
    virtual void fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
                      float* values) const = 0;

    /// Conservative: holds what fill() gives for any voxel, of any coarseness, that lies in the box.
    /// @param low, high  in finest voxels; high is the first not in the box.
    [[nodiscard]] virtual FieldRange range(const glm::i64vec3& low, const glm::i64vec3& high) const = 0;
};

}  // namespace cairn::renderer
