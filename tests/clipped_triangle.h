#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

namespace cairn::test {

/// Whether a closed triangle meets a closed box: the truth's own witness, which shares nothing with
/// separating axes.
///
/// The triangle is clipped by the six sides of the box (Sutherland and Hodgman 1974), and meets it if
/// anything is left. It is clipped in its own barycentric weights, w[0] + w[1] + w[2] > 0, all homogeneous:
/// there it is a proper triangle even when it is a segment or a point in space, each side of the box is a
/// line with whole coefficients, and every corner is the crossing of two lines, so that numbers grow no
/// longer with each cut.
///
/// With coordinates within +-2^40, coefficients are at most 2^41, corners 2^83, and distances under 2^125.6:
/// 128 bits are enough. `Number` may be wider.
template <class Number>
class ClippedTriangle {
public:
    explicit ClippedTriangle(const std::array<glm::i64vec3, 3>& corners) : corners_(corners) {}

    [[nodiscard]] bool meets(const glm::i64vec3& low, const glm::i64vec3& high) const {
        Polygon polygon = whole();
        for (int axis = 0; axis < 3 && polygon.count > 0; ++axis) {
            polygon = cut(polygon, line(axis, 1, low[axis]));
            polygon = cut(polygon, line(axis, -1, high[axis]));
        }
        return polygon.count > 0;
    }

private:
    using Triple = std::array<Number, 3>;

    /// Corners in order, and the line that each follows to the next one.
    struct Polygon {
        std::array<Triple, 9> corners;  ///< three, and one more a cut
        std::array<Triple, 9> lines;
        std::size_t count = 0;

        void add(const Triple& corner, const Triple& line) {
            corners[count] = corner;
            lines[count] = line;
            ++count;
        }
    };

    [[nodiscard]] static Polygon whole() {
        Polygon polygon;
        for (std::size_t i = 0; i < 3; ++i) {
            Triple corner = {0, 0, 0};
            Triple line = {0, 0, 0};
            corner[i] = 1;
            line[(i + 2) % 3] = 1;  // along the side from corner i to the next, the third weight is 0
            polygon.add(corner, line);
        }
        return polygon;
    }

    /// >= 0 where sign * (coordinate - bound) is.
    [[nodiscard]] Triple line(int axis, int sign, std::int64_t bound) const {
        Triple out;
        for (std::size_t i = 0; i < 3; ++i)
            out[i] = sign * (corners_[i][axis] - bound);
        return out;
    }

    [[nodiscard]] static Number dot(const Triple& a, const Triple& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    /// Where two lines cross that do: weights are positive.
    [[nodiscard]] static Triple crossing(const Triple& a, const Triple& b) {
        Triple out = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        if (out[0] + out[1] + out[2] < 0) {
            for (Number& weight : out)
                weight = -weight;
        }
        return out;
    }

    [[nodiscard]] static Polygon cut(const Polygon& polygon, const Triple& by) {
        std::array<int, 9> side{};
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const Number distance = dot(polygon.corners[i], by);
            side[i] = (distance > 0 ? 1 : 0) - (distance < 0 ? 1 : 0);
        }
        Polygon kept;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const int next = side[(i + 1) % polygon.count];
            if (side[i] >= 0) kept.add(polygon.corners[i], side[i] == 0 && next < 0 ? by : polygon.lines[i]);
            if (side[i] * next < 0)
                kept.add(crossing(polygon.lines[i], by), next < 0 ? by : polygon.lines[i]);
        }
        return kept;
    }

    std::array<glm::i64vec3, 3> corners_;
};

}  // namespace cairn::test
