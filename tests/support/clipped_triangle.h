#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <glm/glm.hpp>

namespace cairn::test {

/// A triangle, clipped by half spaces: a second exact predicate, which shares nothing with separating axes.
///
/// A half space is a quantity that is linear over the triangle, and a bound for it (Sutherland and Hodgman
/// 1974). The triangle is clipped in its own barycentric weights, all homogeneous: there it is a proper
/// triangle even if it is a segment or a point in space, the border of each half space is a line with whole
/// coefficients, and every corner is the crossing of two lines, so that numbers do not grow with each cut.
///
/// If values and bounds are within +-2^40, coefficients are at most 2^41, corners 2^83, and distances under
/// 2^125.6: 128 bits are enough. `Number` may be wider.
template <class Number>
class ClippedTriangle {
public:
    /// A quantity, by its values at the three corners.
    using Values = std::array<std::int64_t, 3>;

    ClippedTriangle() {
        for (std::size_t i = 0; i < 3; ++i) {
            Triple corner = {0, 0, 0};
            Triple line = {0, 0, 0};
            corner[i] = 1;
            // Along the side from corner i to the next, the third weight is 0.
            line[(i + 2) % 3] = 1;
            add(corner, line);
        }
    }

    [[nodiscard]] bool empty() const { return count_ == 0; }

    void keep_at_least(const Values& values, std::int64_t bound) {
        cut({values[0] - bound, values[1] - bound, values[2] - bound});
    }
    void keep_at_most(const Values& values, std::int64_t bound) {
        cut({bound - values[0], bound - values[1], bound - values[2]});
    }

private:
    using Triple = std::array<Number, 3>;
    static constexpr std::size_t most_corners = 16;  // three, and one more per cut
    using Triples = std::array<Triple, most_corners>;

    void add(const Triple& corner, const Triple& line) {
        corners_[count_] = corner;
        lines_[count_] = line;
        ++count_;
    }

    [[nodiscard]] static Number dot(const Triple& a, const Triple& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    /// The crossing of two lines within the triangle, where weights are positive.
    [[nodiscard]] static Triple crossing(const Triple& a, const Triple& b) {
        Triple out = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        if (out[0] + out[1] + out[2] < 0) {
            for (Number& weight : out)
                weight = -weight;
        }
        return out;
    }

    /// Keeps the weights whose product with `by` is not negative.
    void cut(const Triple& by) {
        std::array<int, most_corners> sides{};
        bool whole = true;
        for (std::size_t i = 0; i < count_; ++i) {
            const Number distance = dot(corners_[i], by);
            sides[i] = (distance > 0 ? 1 : 0) - (distance < 0 ? 1 : 0);
            whole = whole && sides[i] >= 0;
        }
        if (whole) return;
        Triples corners;
        Triples lines;
        std::move(corners_.begin(), corners_.begin() + count_, corners.begin());
        std::move(lines_.begin(), lines_.begin() + count_, lines.begin());
        const std::size_t count = std::exchange(count_, 0);
        for (std::size_t i = 0; i < count; ++i) {
            const int side = sides[i];
            const int next = sides[(i + 1) % count];
            if (side >= 0) add(corners[i], side == 0 && next < 0 ? by : lines[i]);
            if (side * next < 0) add(crossing(lines[i], by), next < 0 ? by : lines[i]);
        }
    }

    Triples corners_;  ///< corners in order
    Triples lines_;    ///< line from each corner to the next
    std::size_t count_ = 0;
};

template <class Number>
void clip_to_box(ClippedTriangle<Number>& clipped, const std::array<glm::i64vec3, 3>& corners,
                 const glm::i64vec3& low, const glm::i64vec3& high) {
    for (int axis = 0; axis < 3 && !clipped.empty(); ++axis) {
        const std::array<std::int64_t, 3> values = {corners[0][axis], corners[1][axis], corners[2][axis]};
        clipped.keep_at_least(values, low[axis]);
        clipped.keep_at_most(values, high[axis]);
    }
}

/// Whether a closed triangle meets a closed box, coordinates within +-2^40.
template <class Number>
[[nodiscard]] bool is_left_in_box(const std::array<glm::i64vec3, 3>& corners, const glm::i64vec3& low,
                                  const glm::i64vec3& high) {
    ClippedTriangle<Number> clipped;
    clip_to_box(clipped, corners, low, high);
    return !clipped.empty();
}

}  // namespace cairn::test
