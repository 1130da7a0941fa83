#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "voxelizer/grid.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::voxelizer {

/// The rows along an axis whose lines cross one triangle, and the places where they cross it: the arithmetic
/// of RowCrossings.
///
/// Coordinates are in half lattice units, so that the centres of voxels are whole numbers at every level:
/// centre i of an axis is (2 i + 1) * side.
///
/// @tparam Int  64 bits for corners within [-2^24, 2^25], 128 for corners within +-2^40.
template <typename Int>
class CrossedRows {
public:
    using Corners = std::array<std::array<Int, 3>, 3>;

    /// @param corners  lattice units
    CrossedRows(const Corners& corners, const Region& region, int axis)
        : axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3), side_(region.voxel_side()) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k)
                p_[i][std::size_t(k)] = 2 * (corners[i][std::size_t(k)] - Int(region.origin[k]) * side_);
        }
        for (int k = 0; k < 3; ++k)
            normal_[std::size_t(k)] = component(corners, (k + 1) % 3, (k + 2) % 3);
        const Int along = normal_[std::size_t(axis_)];
        if (along == 0) return;
        winding_ = along > 0 ? 1 : -1;
        if (winding_ < 0) std::swap(p_[1], p_[2]);  // counter-clockwise, seen against the axis
        u_last_ = region.size[u_] - 1;
        const auto [low, high] = std::minmax({at(0, v_), at(1, v_), at(2, v_)});
        first_v_ = std::max(voxel_at_or_after(low), 0);
        last_v_ = std::min(voxel_at_or_before(high), region.size[v_] - 1);
        tie_is_beyond_ = tie_is_beyond();
        prepare_filter();
    }

    /// Sign of the crossings, +1 or -1; 0 if the triangle is parallel to the axis.
    [[nodiscard]] int winding() const { return winding_; }
    [[nodiscard]] int first_v() const { return first_v_; }
    [[nodiscard]] int last_v() const { return last_v_; }

    struct Interval {
        int first, last;
    };
    /// The range of u of the rows (u, v) that are crossed, for one v.
    [[nodiscard]] Interval crossed_u(int v) const {
        Interval out{0, u_last_};
        for (std::size_t i = 0; i < 3; ++i)
            narrow(out, p_[i], p_[(i + 1) % 3], v);
        return out;
    }

    /// The first voxel whose centre lies beyond the triangle; any whole number.
    [[nodiscard]] std::int64_t first_beyond(int u, int v) const {
        const double where = plane_ + slope_u_ * (double(u) - at_u_) + slope_v_ * (double(v) - at_v_);
        const std::int64_t nearest = std::int64_t(std::floor(where + 0.5));
        if (std::abs(where - double(nearest)) <= error_) return exactly_first_beyond(u, v);
        return double(nearest) > where ? nearest : nearest + 1;
    }

private:
    [[nodiscard]] std::int64_t exactly_first_beyond(int u, int v) const {
        const Int128 du = Int128(2 * u + 1) * side_ - at(0, u_);
        const Int128 dv = Int128(2 * v + 1) * side_ - at(0, v_);
        const Int128 along = normal_[std::size_t(axis_)];
        const Int128 divisor = winding_ * along;
        const Int128 offset =
            winding_ * (Int128(normal_[std::size_t(u_)]) * du + Int128(normal_[std::size_t(v_)]) * dv);
        const Int128 numerator = (Int128(at(0, axis_)) - side_) * divisor - offset;
        const Int128 whole = divisor * (2 * side_);
        const Int128 beyond =
            tie_is_beyond_ ? ceil_divide(numerator, whole) : floor_divide(numerator, whole) + 1;
        return std::int64_t(beyond);
    }

    /// Prepares the plane in doubles, in voxels, from corner 0: all values are exact but the slopes. Within
    /// the triangle no term passes its slope times the triangle's extent, and a handful of roundings add up.
    void prepare_filter() {
        const double unit = 0.5 / double(side_);
        const double along = double(normal_[std::size_t(axis_)]);
        slope_u_ = -double(normal_[std::size_t(u_)]) / along;
        slope_v_ = -double(normal_[std::size_t(v_)]) / along;
        plane_ = double(at(0, axis_)) * unit - 0.5;
        at_u_ = double(at(0, u_)) * unit - 0.5;
        at_v_ = double(at(0, v_)) * unit - 0.5;
        const double reach = std::abs(slope_u_) * extent(u_) + std::abs(slope_v_) * extent(v_);
        error_ = 0x1p-48 * (reach * unit + std::abs(plane_) + 1.0);
        if (sizeof(Int) > sizeof(std::int64_t) || !(error_ < 0.25)) error_ = 1.0;  // always in doubt
    }
    [[nodiscard]] double extent(int axis) const {
        const auto [low, high] = std::minmax({at(0, axis), at(1, axis), at(2, axis)});
        return double(high - low);
    }
    [[nodiscard]] Int at(std::size_t corner, int axis) const { return p_[corner][std::size_t(axis)]; }

    static Int component(const Corners& p, int a, int b) {
        const auto i = std::size_t(a);
        const auto k = std::size_t(b);
        return (p[1][i] - p[0][i]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][i] - p[0][i]);
    }
    static Int floored(Int numerator, Int positive_divisor) {
        const Int quotient = numerator / positive_divisor;
        return numerator % positive_divisor < 0 ? quotient - 1 : quotient;
    }
    static int limited(Int value) { return int(std::clamp<Int>(value, -1, Int(1) << 30)); }

    [[nodiscard]] int voxel_at_or_before(Int coordinate) const {
        return limited(floored(coordinate - side_, 2 * side_));
    }
    [[nodiscard]] int voxel_at_or_after(Int coordinate) const {
        return limited(-floored(side_ - coordinate, 2 * side_));
    }

    /// Keeps the rows on the inner side of the edge from p to q: du (v' - p.v) - dv (u' - p.u) > 0, where a
    /// tie is broken by the move of the centre: of u and v, the one that comes first in x, y, z moves more.
    void narrow(Interval& rows, const std::array<Int, 3>& p, const std::array<Int, 3>& q, int v) const {
        const auto u_axis = std::size_t(u_);
        const auto v_axis = std::size_t(v_);
        const Int du = q[u_axis] - p[u_axis];
        const Int dv = q[v_axis] - p[v_axis];
        const bool v_moves_more = v_ < u_;
        const bool tie_is_inside = v_moves_more ? (du != 0 ? du > 0 : dv < 0) : (dv != 0 ? dv < 0 : du > 0);
        const Int centre_v = Int(2 * v + 1) * side_;
        const Int rest =
            du * (centre_v - p[v_axis]) + dv * (p[u_axis] - side_) - (tie_is_inside ? Int(0) : Int(1));
        // rest >= dv * 2 side * u'
        if (dv > 0) {
            rows.last = std::min(rows.last, limited(floored(rest, 2 * side_ * dv)));
        } else if (dv < 0) {
            rows.first = std::max(rows.first, limited(-floored(rest, -2 * side_ * dv)));
        } else if (rest < 0) {
            rows = {1, 0};
        }
    }

    /// Whether a centre exactly on the triangle's plane lies beyond it once moved. With the normal n, the
    /// move (e, e^2, e^3) goes along n by n.x e + n.y e^2 + n.z e^3, whose sign is that of the first that is
    /// not 0.
    [[nodiscard]] bool tie_is_beyond() const {
        const Int along = normal_[std::size_t(axis_)];
        for (const Int component : normal_) {
            if (component != 0) return (component > 0) == (along > 0);
        }
        return true;
    }

    int axis_, u_, v_;
    std::int64_t side_;
    Corners p_;                  ///< corners, in half lattice units from the region's low corner
    std::array<Int, 3> normal_;  ///< normal before corners were swapped, lattice units
    int winding_ = 0;
    int u_last_ = -1, first_v_ = 0, last_v_ = -1;
    bool tie_is_beyond_ = false;
    double plane_ = 0.0, slope_u_ = 0.0, slope_v_ = 0.0, at_u_ = 0.0, at_v_ = 0.0, error_ = 1.0;
};

}  // namespace cairn::voxelizer
