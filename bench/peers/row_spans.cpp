#include "bench/peers/row_spans.h"

#include <algorithm>
#include <cmath>

#include "voxelizer/surface/wide_integer.h"

namespace cairn::bench {
namespace {

std::int64_t floor_divide(std::int64_t numerator, std::int64_t positive_divisor) {
    const std::int64_t quotient = numerator / positive_divisor;
    return quotient - std::int64_t(numerator % positive_divisor < 0);
}
std::int64_t ceil_divide(std::int64_t numerator, std::int64_t positive_divisor) {
    return -floor_divide(-numerator, positive_divisor);
}

/// The corners counter-clockwise, so that (-edge.v, edge.u) points inwards. For a triangle without area, its
/// longest side, there and back, so that both sides of its axis are tested.
std::array<glm::i64vec2, 3> wind(const std::array<glm::i64vec2, 3>& p) {
    const glm::i64vec2 ab = p[1] - p[0];
    const glm::i64vec2 ac = p[2] - p[0];
    const std::int64_t area = ab.x * ac.y - ab.y * ac.x;
    if (area > 0) return p;
    if (area < 0) return {p[0], p[2], p[1]};
    std::size_t longest = 0;
    std::int64_t length = -1;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::i64vec2 d = glm::abs(p[(i + 1) % 3] - p[i]);
        if (d.x + d.y > length) {
            length = d.x + d.y;
            longest = i;
        }
    }
    return {p[longest], p[(longest + 1) % 3], p[longest]};
}

/// Limits a bound to values that fit an int. The limits are half a voxel from all values that count, so they
/// change no decision.
double limited(double bound, int last) {
    return std::min(std::max(bound, -0.5), double(last) + 1.5);
}

/// The floor of a limited bound; by truncation, because std::floor is a call without SSE 4.1.
int floor_of(double bound) {
    return int(bound + 1.0) - 1;
}

bool near_whole(double bound, double error) {
    return std::abs(bound - double(floor_of(bound + 0.5))) <= error;
}

/// The closed voxels that touch [lowest, highest]: ceil(lowest) - 1 to floor(highest).
Span touched_between(double lowest, double highest, int last) {
    const int below = floor_of(lowest);
    const int first = double(below) == lowest ? below - 1 : below;
    return {std::max(first, 0), std::min(floor_of(highest), last)};
}

Span meet(const Span& a, const Span& b) {
    return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

}  // namespace

ProjectedSides::ProjectedSides(const std::array<glm::i64vec2, 3>& corners, int shift, int voxels_of_u)
    : corners_(wind(corners)), shift_(shift), last_(voxels_of_u - 1) {
    const double unit = std::ldexp(1.0, -shift);
    bool slanted = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::i64vec2& p = corners_[i];
        const glm::i64vec2& q = corners_[(i + 1) % 3];
        const glm::i64vec2 inward(p.y - q.y, q.x - p.x);
        if (inward.x == 0) continue;  // parallel to u: the bounding box is the same bound
        // A row's innermost edge is its upper one if the side faces up.
        const Side side{double(p.x) * unit, double(p.y) * unit - (inward.y > 0 ? 1.0 : 0.0),
                        double(inward.y) / double(inward.x)};
        slanted = slanted || inward.y != 0;
        if (inward.x > 0) {
            lower_[std::size_t(lower_count_++)] = side;
        } else {
            upper_[std::size_t(upper_count_++)] = side;
        }
    }
    // Terms are rounded three times. If the bound is not far outside, each is under twice the size, so 2^-50
    // of the size would do. Upright sides have exact bounds.
    error_ = slanted ? 0x1p-46 * double(voxels_of_u + 1) : -1.0;
}

Span ProjectedSides::touched(int v) const {
    double lowest = -0.5;
    double highest = double(last_) + 1.5;
    for (int i = 0; i < lower_count_; ++i) {
        const Side& side = lower_[std::size_t(i)];
        lowest = std::max(lowest, side.u - side.slope * (double(v) - side.v));
    }
    for (int i = 0; i < upper_count_; ++i) {
        const Side& side = upper_[std::size_t(i)];
        highest = std::min(highest, side.u - side.slope * (double(v) - side.v));
    }
    lowest = limited(lowest, last_);
    highest = limited(highest, last_);
    if (near_whole(lowest, error_) || near_whole(highest, error_)) return exactly_touched(v);
    return touched_between(lowest, highest, last_);
}

Span ProjectedSides::exactly_touched(int v) const {
    Span span{0, last_};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::i64vec2& p = corners_[i];
        const glm::i64vec2& q = corners_[(i + 1) % 3];
        const glm::i64vec2 inward(p.y - q.y, q.x - p.x);
        if (inward.x == 0) continue;
        const std::int64_t row = (std::int64_t(v) + (inward.y > 0 ? 1 : 0)) << shift_;
        // inward.x * u >= inward.x * p.u - inward.v * (row - p.v), all products below 2^53
        const std::int64_t rest = inward.x * p.x - inward.y * (row - p.y);
        const std::int64_t divisor = std::abs(inward.x) << shift_;
        if (inward.x > 0) {
            span.first = int(std::clamp<std::int64_t>(ceil_divide(rest, divisor) - 1, span.first, last_ + 1));
        } else {
            span.last = int(std::clamp<std::int64_t>(floor_divide(-rest, divisor), -1, span.last));
        }
    }
    return span;
}

namespace {

std::array<glm::i64vec2, 3> projected(const std::array<glm::ivec3, 3>& p, const glm::ivec3& low, int shift,
                                      int u, int v) {
    std::array<glm::i64vec2, 3> out;
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = {p[i][u] - (std::int64_t(low[u]) << shift), p[i][v] - (std::int64_t(low[v]) << shift)};
    }
    return out;
}

}  // namespace

RowSpans::RowSpans(const std::array<glm::ivec3, 3>& corners, int shift)
    : low_(low_voxel(corners, shift)),
      high_(high_voxel(corners, shift)),
      shift_(shift),
      corner_(glm::i64vec3(corners[0]) - (glm::i64vec3(low_) << std::int64_t(shift))),
      xy_(projected(corners, low_, shift, 0, 1), shift, high_.x - low_.x + 1),
      xz_(projected(corners, low_, shift, 0, 2), shift, high_.x - low_.x + 1),
      yz_(projected(corners, low_, shift, 1, 2), shift, high_.y - low_.y + 1) {
    const glm::i64vec3 ab(corners[1] - corners[0]);
    const glm::i64vec3 ac(corners[2] - corners[0]);
    normal_ = {ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x};
    if (normal_.x < 0) normal_ = -normal_;
    has_plane_ = normal_.x != 0;
    if (!has_plane_) return;
    // Components of the normal are whole numbers below 2^53, so each slope is rounded once.
    slope_ = -glm::dvec2(double(normal_.y), double(normal_.z)) / double(normal_.x);
    const glm::dvec3 at = glm::dvec3(corner_) * std::ldexp(1.0, -shift);
    // The plane's lowest x over the row is at the corner towards which it slopes down.
    const glm::dvec2 lowest(slope_.x < 0.0 ? 1.0 : 0.0, slope_.y < 0.0 ? 1.0 : 0.0);
    plane_at_low_ = at.x + slope_.x * (lowest.x - at.y) + slope_.y * (lowest.y - at.z);
    plane_width_ = std::abs(slope_.x) + std::abs(slope_.y);
    const glm::dvec3 size(high_ - low_ + 2);
    const double reach = std::abs(slope_.x) * size.y + std::abs(slope_.y) * size.z;
    plane_error_ = reach > 0.0 ? 0x1p-47 * (reach + size.x) : -1.0;
}

RowSpans::Slice::Slice(const RowSpans& triangle, int z)
    : triangle_(triangle),
      z_(z - triangle.low_.z),
      rows_(triangle.yz_.touched(z_)),
      by_xz_(triangle.xz_.touched(z_)),
      plane_(triangle.plane_at_low_ + triangle.slope_.y * double(z_)) {
    if (by_xz_.empty()) rows_ = {1, 0};
    rows_.first += triangle.low_.y;
    rows_.last += triangle.low_.y;
}

Span RowSpans::Slice::row(int y) const {
    const RowSpans& t = triangle_;
    const int v = y - t.low_.y;
    Span span = meet(by_xz_, t.xy_.touched(v));
    if (t.has_plane_) {
        const int last = t.high_.x - t.low_.x;
        const double lowest = limited(plane_ + t.slope_.x * double(v), last);
        const double highest = limited(plane_ + t.slope_.x * double(v) + t.plane_width_, last);
        const bool doubtful = t.plane_error_ >= 0.25 || near_whole(lowest, t.plane_error_) ||
                              near_whole(highest, t.plane_error_);
        span = meet(span, doubtful ? t.exact_plane(v, z_) : touched_between(lowest, highest, last));
    }
    return {span.first + t.low_.x, span.last + t.low_.x};
}

Span RowSpans::exact_plane(int y, int z) const {
    using voxelizer::Int128;
    Span span{0, high_.x - low_.x};
    const std::int64_t side = std::int64_t(1) << shift_;
    const Int128 divisor = Int128(normal_.x) * side;
    for (const bool lower : {true, false}) {
        const std::int64_t dy = (y + std::int64_t((normal_.y > 0) == lower)) * side - corner_.y;
        const std::int64_t dz = (z + std::int64_t((normal_.z > 0) == lower)) * side - corner_.z;
        const Int128 rest = Int128(normal_.x) * corner_.x - Int128(normal_.y) * dy - Int128(normal_.z) * dz;
        if (lower) {
            const Int128 first = voxelizer::ceil_divide(rest, divisor) - 1;
            span.first = int(std::clamp<Int128>(first, 0, span.last + 1));
        } else {
            span.last = int(std::clamp<Int128>(voxelizer::floor_divide(rest, divisor), -1, span.last));
        }
    }
    return span;
}

}  // namespace cairn::bench
