#include "voxelizer/surface/exact_mask.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/scene.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::voxelizer {
namespace {

/// Non-negative on one side: x * weight 0 + y * weight 1 + z * weight 2 >= 0.
using Line = Wide3;

/// The line where a quantity, known at the three vertices, is at least, or at most, a bound.
Line at_least(const std::array<std::int64_t, 3>& values, std::int64_t bound) {
    return {values[0] - bound, values[1] - bound, values[2] - bound};
}
Line at_most(const std::array<std::int64_t, 3>& values, std::int64_t bound) {
    return {bound - values[0], bound - values[1], bound - values[2]};
}

/// The corners of what lies on the right side of all lines, the triangle's own three among them; none =
/// empty.
std::vector<Wide3> corners_of(const std::vector<Line>& lines) {
    std::vector<Wide3> corners;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            Wide3 p = cross(lines[i], lines[j]);
            if (p.x < 0 || p.y < 0 || p.z < 0) p = {-p.x, -p.y, -p.z};
            if (p.x == 0 && p.y == 0 && p.z == 0) continue;
            const bool inside =
                std::all_of(lines.begin(), lines.end(), [&](const Line& line) { return dot(line, p) >= 0; });
            if (inside) corners.push_back(p);
        }
    }
    return corners;
}

std::int64_t wrapped(std::int64_t texel, std::int64_t period, std::int64_t size, std::uint32_t mode) {
    // Far from zero only the remainder by two textures matters, or the end.
    const std::int64_t place =
        texel + std::clamp<std::int64_t>(period, -TEXCOORD_LIMIT, TEXCOORD_LIMIT) * size;
    if (mode == std::uint32_t(scenes::Wrap::clamp_to_edge))
        return std::clamp<std::int64_t>(place, 0, size - 1);
    const std::int64_t twice = ((place % (2 * size)) + 2 * size) % (2 * size);
    if (mode == std::uint32_t(scenes::Wrap::mirrored_repeat))
        return twice < size ? twice : 2 * size - 1 - twice;
    return twice % size;
}

struct Range {
    std::int64_t first, last;
};

/// The whole steps [i, i + 1] * side that a quantity touches over some corners.
Range steps_touched(const std::vector<Wide3>& corners, const std::array<std::int64_t, 3>& values,
                    std::int64_t side) {
    Range range{INT64_MAX, INT64_MIN};
    for (const Wide3& p : corners) {
        const Int128 numerator = p.x * values[0] + p.y * values[1] + p.z * values[2];
        const Int128 divisor = (p.x + p.y + p.z) * side;
        range.first = std::min(range.first, std::int64_t(ceil_divide(numerator, divisor)) - 1);
        range.last = std::max(range.last, std::int64_t(floor_divide(numerator, divisor)));
    }
    return range;
}

}  // namespace

ExactMask::ExactMask(const std::array<glm::i64vec3, 3>& positions, const std::array<glm::vec2, 3>& texcoords,
                     const std::array<std::uint16_t, 3>& alphas, const interop::SurfaceMaterial& material,
                     std::span<const std::uint32_t> texels)
    : positions_(positions), material_(material), texels_(texels) {
    for (std::size_t i = 0; i < 3; ++i)
        alphas_[i] = alphas[i];
    const glm::dvec2 size(std::max(material.width, 1U), std::max(material.height, 1U));
    const glm::dvec2 period =
        glm::floor(glm::dvec2(glm::min(glm::min(texcoords[0], texcoords[1]), texcoords[2])));
    const glm::dvec2 span =
        (glm::dvec2(glm::max(glm::max(texcoords[0], texcoords[1]), texcoords[2])) - period) * size *
        double(TEXEL_UNITS);
    double units = TEXEL_UNITS;
    for (double most = std::max(span.x, span.y); most > TEXEL_COORDINATE_LIMIT; most *= 0.5)
        units *= 0.5;
    texel_side_ = std::int64_t(units);
    period_ = glm::i64vec2(period);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 exact = (glm::dvec2(texcoords[i]) - period) * (size * units);
        texel_coordinates_[i] = {std::int64_t(std::nearbyint(exact.x)),
                                 std::int64_t(std::nearbyint(exact.y))};
    }
}

std::int64_t ExactMask::alpha_at(std::int64_t column, std::int64_t row) const {
    if (material_.width == 0) return 255;
    const std::int64_t x =
        wrapped(column, period_.x, material_.width, material_.flags >> MATERIAL_WRAP_S_SHIFT & 3U);
    const std::int64_t y =
        wrapped(row, period_.y, material_.height, material_.flags >> MATERIAL_WRAP_T_SHIFT & 3U);
    return texels_[material_.texel_offset + std::size_t(y) * material_.width + std::size_t(x)] >> 24;
}

bool ExactMask::touches(const glm::i64vec3& low, std::int64_t side) const {
    std::vector<Line> lines = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; ++axis) {
        const std::array<std::int64_t, 3> values = {positions_[0][axis], positions_[1][axis],
                                                    positions_[2][axis]};
        lines.push_back(at_least(values, low[axis]));
        lines.push_back(at_most(values, low[axis] + side));
    }
    const std::array<std::int64_t, 3> u = {texel_coordinates_[0].x, texel_coordinates_[1].x,
                                           texel_coordinates_[2].x};
    const std::array<std::int64_t, 3> v = {texel_coordinates_[0].y, texel_coordinates_[1].y,
                                           texel_coordinates_[2].y};
    const std::vector<Wide3> corners = corners_of(lines);
    if (corners.empty()) return false;
    const Range columns = steps_touched(corners, u, texel_side_);
    const Range rows = steps_touched(corners, v, texel_side_);
    for (std::int64_t row = rows.first; row <= rows.last; ++row) {
        for (std::int64_t column = columns.first; column <= columns.last; ++column) {
            const std::int64_t alpha = alpha_at(column, row) * 256;
            const Line passes = at_least({alpha * alphas_[0], alpha * alphas_[1], alpha * alphas_[2]},
                                         std::int64_t(material_.alpha_threshold) * 257);
            if (passes.x < 0 && passes.y < 0 && passes.z < 0) continue;
            std::vector<Line> all = lines;
            all.push_back(at_least(u, column * texel_side_));
            all.push_back(at_most(u, (column + 1) * texel_side_));
            all.push_back(at_least(v, row * texel_side_));
            all.push_back(at_most(v, (row + 1) * texel_side_));
            all.push_back(passes);
            if (!corners_of(all).empty()) return true;
        }
    }
    return false;
}

}  // namespace cairn::voxelizer
