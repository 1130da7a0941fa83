#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::bench {

/// Whole numbers from `first` to `last`; empty if first > last.
struct Span {
    int first, last;
    [[nodiscard]] bool empty() const { return first > last; }
};

/// One projection of a triangle, as bounds of `u` for each row of `v`: u and v are two of the axes.
///
/// Bounds are doubles in voxels from the triangle's low corner, in which vertices are exact. If the nearest
/// voxel plane is within the error of rounding, whole numbers of 64 bits decide.
class ProjectedSides {
public:
    /// @param corners  (u, v) in lattice units relative to the low corner's, at most 2^26
    /// @param shift    log2 of a voxel's side
    ProjectedSides(const std::array<glm::i64vec2, 3>& corners, int shift, int voxels_of_u);

    /// Voxels of the closed row from `v` to `v + 1` that can be touched, by these sides alone.
    [[nodiscard]] Span touched(int v) const;

private:
    struct Side {
        double u, v;   ///< corner; v is moved to the row's innermost edge
        double slope;  ///< u = this->u - slope * (row - this->v)
    };
    [[nodiscard]] Span exactly_touched(int v) const;

    std::array<glm::i64vec2, 3> corners_;  ///< counter-clockwise; if flat, there and back
    std::array<Side, 3> lower_, upper_;
    int lower_count_ = 0, upper_count_ = 0;
    int shift_;
    int last_;
    double error_;
};

/// The box of voxels that a triangle's own box touches. A voxel that ends where it begins is touched too.
[[nodiscard]] inline glm::ivec3 low_voxel(const std::array<glm::ivec3, 3>& p, int shift) {
    return (glm::min(glm::min(p[0], p[1]), p[2]) - 1) >> shift;
}
[[nodiscard]] inline glm::ivec3 high_voxel(const std::array<glm::ivec3, 3>& p, int shift) {
    return glm::max(glm::max(p[0], p[1]), p[2]) >> shift;
}

/// The voxels that a closed triangle touches, row by row along x.
class RowSpans {
public:
    /// @param corners  corners in lattice units, within [-2^24, 2^25]
    /// @param shift    log2 of a voxel's side
    RowSpans(const std::array<glm::ivec3, 3>& corners, int shift);

    [[nodiscard]] const glm::ivec3& low() const { return low_; }
    [[nodiscard]] const glm::ivec3& high() const { return high_; }

    /// The rows of one z within [low().z, high().z].
    class Slice {
    public:
        /// Values of y whose rows can touch the triangle.
        [[nodiscard]] const Span& rows() const { return rows_; }
        /// Values of x that touch the triangle. @param y  within rows().
        [[nodiscard]] Span row(int y) const;

    private:
        friend class RowSpans;
        Slice(const RowSpans& triangle, int z);
        const RowSpans& triangle_;
        int z_;
        Span rows_, by_xz_;
        double plane_;
    };
    [[nodiscard]] Slice slice(int z) const { return {*this, z}; }

private:
    [[nodiscard]] Span exact_plane(int y, int z) const;

    glm::ivec3 low_, high_;
    int shift_;
    /// A corner in lattice units, relative to the low corner.
    glm::i64vec3 corner_;
    glm::i64vec3 normal_;  ///< normal with x >= 0
    ProjectedSides xy_, xz_, yz_;
    bool has_plane_;
    /// Slopes along y and z of the plane's lowest x in a row.
    glm::dvec2 slope_{0.0};
    double plane_at_low_ = 0.0, plane_width_ = 0.0, plane_error_ = 0.0;
};

}  // namespace cairn::bench
