#include "tests/support/exact_rays.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "renderer/produce/fractal_content.h"

namespace cairn::test {
namespace {

using glm::i64vec3;

/// A time num / den, with den > 0.
struct Fraction {
    Wide num = 0;
    std::int64_t den = 1;
};
bool less(const Fraction& a, const Fraction& b) {
    return a.num * b.den < b.num * a.den;
}

Wide floor_divide(Wide a, Wide b) {
    const Wide q = a / b;
    return a % b < 0 ? q - 1 : q;
}

class Walk {
public:
    Walk(const std::vector<Space>& spaces, const ExactRay& ray) : spaces_(spaces), ray_(ray) {}

    bool enter();
    void go(const std::function<bool(const Crossed&)>& visit);

private:
    [[nodiscard]] const Space& space() const { return spaces_[std::size_t(at_.space)]; }
    [[nodiscard]] int unit_shift() const { return space().voxel_shift + ray_.fraction_bits; }
    /// The time at which the ray meets the plane before voxel `voxel` of an axis.
    [[nodiscard]] Fraction time_of(int axis, std::int64_t voxel) const {
        const Wide way = (Wide(voxel) << unit_shift()) - ray_.origin[axis];
        const std::int64_t d = ray_.direction[axis];
        return d > 0 ? Fraction{way, d} : Fraction{-way, -d};
    }
    [[nodiscard]] std::int64_t voxel_at(int axis, const Fraction& t) const {
        const Wide place = ray_.origin[axis] * t.den + Wide(ray_.direction[axis]) * t.num;
        return std::int64_t(floor_divide(place, t.den) >> unit_shift());
    }
    [[nodiscard]] bool is_inside() const {
        const i64vec3 place = at_.voxel - space().low;
        return glm::all(glm::greaterThanEqual(place, i64vec3(0))) &&
               glm::all(glm::lessThan(place, i64vec3(space().side)));
    }
    [[nodiscard]] int empty_shift() const;
    bool step_over(int shift);

    const std::vector<Space>& spaces_;
    const ExactRay& ray_;
    Crossed at_;
};

/// The voxel where the ray starts: that of the first space at the origin or, if the ray comes from outside
/// the only space, the first voxel that it meets.
bool Walk::enter() {
    Fraction first{0, 1};
    int entered = -1;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t low = space().low[axis];
        const std::int64_t high = low + space().side;
        if (ray_.direction[axis] == 0) {
            const Wide o = ray_.origin[axis];
            if (o < Wide(low) << unit_shift() || o > Wide(high) << unit_shift()) return false;
            continue;
        }
        const Fraction t = time_of(axis, ray_.direction[axis] > 0 ? low : high);
        if (less(first, t)) {
            first = t;
            entered = axis;
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (ray_.direction[axis] != 0) {
            const bool forward = ray_.direction[axis] > 0;
            if (less(time_of(axis, space().low[axis] + (forward ? space().side : 0)), first)) return false;
        }
        const std::int64_t low = space().low[axis];
        at_.voxel[axis] = std::clamp(voxel_at(axis, first), low, low + space().side - 1);
    }
    if (entered >= 0) {
        const std::int64_t low = space().low[entered];
        at_.voxel[entered] = ray_.direction[entered] > 0 ? low : low + space().side - 1;
    }
    return true;
}

/// -1 if the voxel is occupied, else log2 of the side of an empty aligned cell around it.
int Walk::empty_shift() const {
    if (renderer::fractal::occupied(at_.voxel, space().bits)) return -1;
    const i64vec3& v = at_.voxel;
    const std::int64_t outside = v.x >> space().bits | v.y >> space().bits | v.z >> space().bits;
    if (outside != 0) return space().step_shift;
    const auto common = std::uint64_t(v.x & v.y & v.z);
    return std::min(int(std::bit_width(common)) - 1, space().step_shift);
}

/// False if the ray has left the last space.
bool Walk::step_over(int shift) {
    const i64vec3 low = at_.voxel >> std::int64_t(shift) << std::int64_t(shift);
    const i64vec3 end = low + (std::int64_t(1) << shift);
    int leaves = -1;
    Fraction exit;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray_.direction[axis] == 0) continue;
        const Fraction t = time_of(axis, ray_.direction[axis] > 0 ? end[axis] : low[axis]);
        if (leaves >= 0 && !less(t, exit)) continue;
        exit = t;
        leaves = axis;
    }
    if (leaves < 0) return false;
    for (int axis = 0; axis < 3; ++axis) {
        const bool forward = ray_.direction[axis] > 0;
        std::int64_t& v = at_.voxel[axis];
        if (axis == leaves) {
            v = forward ? end[axis] : low[axis] - 1;
        } else if (ray_.direction[axis] != 0) {
            const std::int64_t place = std::clamp(voxel_at(axis, exit), low[axis], end[axis] - 1);
            v = forward ? std::max(v, place) : std::min(v, place);
        }
    }
    while (!is_inside()) {
        if (at_.space + 1 == int(spaces_.size())) return false;
        const int old_shift = space().voxel_shift;
        ++at_.space;
        at_.voxel = at_.voxel >> std::int64_t(space().voxel_shift - old_shift);
    }
    return true;
}

void Walk::go(const std::function<bool(const Crossed&)>& visit) {
    for (;;) {
        const int shift = empty_shift();
        if (shift < 0 && visit(at_)) return;
        if (!step_over(std::max(shift, 0))) return;
    }
}

}  // namespace

void cross_occupied(const std::vector<Space>& spaces, const ExactRay& ray,
                    const std::function<bool(const Crossed&)>& visit) {
    Walk walk(spaces, ray);
    if (walk.enter()) walk.go(visit);
}

Interval inside(const std::vector<Space>& spaces, const ExactRay& ray, const Crossed& voxel,
                long double margin) {
    const Space& space = spaces[std::size_t(voxel.space)];
    const int shift = space.voxel_shift + ray.fraction_bits;
    const long double side = (long double)(Wide(1) << shift);
    Interval interval{0.0L, std::numeric_limits<long double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        const long double low =
            (long double)((Wide(voxel.voxel[axis]) << shift) - ray.origin[axis]) - margin * side;
        const long double high = low + side + 2.0L * margin * side;
        const auto d = (long double)(ray.direction[axis]);
        if (d == 0.0L) {
            if (low > 0.0L || high < 0.0L) return {};
            continue;
        }
        interval.first = std::max(interval.first, std::min(low / d, high / d));
        interval.last = std::min(interval.last, std::max(low / d, high / d));
    }
    return interval;
}

}  // namespace cairn::test
