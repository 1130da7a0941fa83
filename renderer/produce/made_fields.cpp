#include "renderer/produce/made_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::renderer {
namespace {

std::int64_t power(int n, int exponent) {
    std::int64_t side = 1;
    for (int i = 0; i < exponent; ++i)
        side *= n;
    return side;
}

/// Nearest and farthest distance from a point to a box.
std::pair<double, double> distances(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 nearest = glm::clamp(point, low, high);
    const glm::dvec3 farthest = glm::max(glm::abs(point - low), glm::abs(point - high));
    return {glm::distance(point, nearest), glm::length(farthest)};
}

/// A run of voxels that follow each other in one copy.
struct Run {
    int first = 0;  ///< first voxel, in the box that is filled
    int count = 0;
    std::int64_t inside = 0;  ///< first voxel, in the copy
};

std::vector<Run> runs(std::int64_t low, int count, std::int64_t period, std::int64_t end) {
    std::vector<Run> found;
    for (int at = 0; at < count;) {
        const std::int64_t voxel = low + at;
        if (voxel >= end) break;
        if (voxel < 0) {
            at = int(std::min<std::int64_t>(count, -low));
            continue;
        }
        const std::int64_t inside = voxel % period;
        const int length = int(std::min<std::int64_t>({count - at, period - inside, end - voxel}));
        found.push_back({at, length, inside});
        at += length;
    }
    return found;
}

}  // namespace

HollowSphere::HollowSphere(int n, std::int64_t resolution, double inner, double outer, double side) {
    if (!(inner >= 0.0 && inner < outer && outer <= 0.5) || resolution < 1 || !(side > 0.0)) {
        throw Error(Fault::usage, "hollow sphere",
                    fmt::format("radii {} and {} of {} voxels", inner, outer, resolution),
                    "the inner one is less than the outer one, which is at most half the side");
    }
    const auto voxels = double(resolution);
    frame_ = {n, glm::dvec3(-0.5 * side), side / voxels, glm::i64vec3(resolution)};
    inner_ = inner * voxels;
    outer_ = outer * voxels;
    centre_ = glm::dvec3(0.5 * voxels);
}

void HollowSphere::fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
                        float* values) const {
    const auto side = double(power(frame_.n, coarseness));
    const auto within = [side](double radius, double distance) {
        return std::clamp(0.5 + (radius - distance) / side, 0.0, 1.0);
    };
    for (int z = 0; z < count.z; ++z) {
        for (int y = 0; y < count.y; ++y) {
            for (int x = 0; x < count.x; ++x) {
                const glm::dvec3 middle = (glm::dvec3(low + glm::i64vec3(x, y, z)) + 0.5) * side;
                const double distance = glm::distance(middle, centre_);
                const double hollow = inner_ > 0.0 ? within(inner_, distance) : 0.0;
                *values++ = float(within(outer_, distance) - hollow);
            }
        }
    }
}

FieldRange HollowSphere::range(const glm::i64vec3& low, const glm::i64vec3& high) const {
    // The mean of a voxel depends on the ball inscribed in it, which lies in the box as the voxel does.
    const auto [nearest, farthest] = distances(centre_, glm::dvec3(low), glm::dvec3(high));
    if (nearest >= outer_ || farthest <= inner_) return {};
    if (farthest <= outer_ && (nearest >= inner_ || inner_ == 0.0)) return {1.0F, 1.0F};
    return {0.0F, 1.0F};
}

RepeatedField::RepeatedField(std::shared_ptr<const Field> field, int copies)
    : field_(std::move(field)), copies_(copies) {
    if (copies < 1 || copies > 1 << 20) {
        throw Error(Fault::usage, "copies of a volume", fmt::format("{} along an axis", copies),
                    "1 to 1048576 are possible");
    }
    frame_ = field_->frame();
    const std::int64_t longest = std::max({frame_.size.x, frame_.size.y, frame_.size.z});
    while (period_ < longest) {
        period_ *= frame_.n;
        ++period_power_;
    }
    frame_.size = glm::i64vec3(period_ * copies);
    field_->fill(period_power_, glm::i64vec3(0), glm::ivec3(1), &mean_);
}

/// Voxels that are wider than a copy: the mean of a copy times the share that copies take.
void RepeatedField::fill_across(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
                                float* values) const {
    const std::int64_t side = power(frame_.n, coarseness - period_power_);  // in copies
    const auto share = [&](std::int64_t voxel) {
        const std::int64_t first = std::max<std::int64_t>(voxel * side, 0);
        const std::int64_t end = std::min<std::int64_t>((voxel + 1) * side, copies_);
        return float(double(std::max<std::int64_t>(end - first, 0)) / double(side));
    };
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                *values++ = mean_ * share(low.x + x) * share(low.y + y) * share(low.z + z);
}

void RepeatedField::fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count,
                         float* values) const {
    if (coarseness > period_power_) {
        fill_across(coarseness, low, count, values);
        return;
    }
    const std::int64_t period = power(frame_.n, period_power_ - coarseness);
    std::fill_n(values, std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z), 0.0F);
    const std::array along{runs(low.x, count.x, period, period * copies_),
                           runs(low.y, count.y, period, period * copies_),
                           runs(low.z, count.z, period, period * copies_)};
    std::vector<float> part;
    for (const Run& z : along[2]) {
        for (const Run& y : along[1]) {
            for (const Run& x : along[0]) {
                part.resize(std::size_t(x.count) * std::size_t(y.count) * std::size_t(z.count));
                field_->fill(coarseness, {x.inside, y.inside, z.inside}, {x.count, y.count, z.count},
                             part.data());
                for (int k = 0; k < z.count; ++k)
                    for (int j = 0; j < y.count; ++j)
                        std::copy_n(part.begin() + std::ptrdiff_t(x.count) * (j + y.count * k), x.count,
                                    values + x.first +
                                        std::ptrdiff_t(count.x) *
                                            (y.first + j + std::ptrdiff_t(count.y) * (z.first + k)));
            }
        }
    }
}

FieldRange RepeatedField::range(const glm::i64vec3& low, const glm::i64vec3& high) const {
    const glm::i64vec3 first = glm::max(low, glm::i64vec3(0));
    const glm::i64vec3 end = glm::min(high, frame_.size);
    if (glm::any(glm::lessThanEqual(end, first))) return {};
    // Along each axis the box lies in one copy, or in the end of one and the start of the next, or holds a
    // whole one.
    std::array<std::vector<std::pair<std::int64_t, std::int64_t>>, 3> parts;
    for (int axis = 0; axis < 3; ++axis) {
        auto& part = parts[std::size_t(axis)];
        const std::int64_t a = first[axis] % period_;
        const std::int64_t length = end[axis] - first[axis];
        if (length >= period_) {
            part.emplace_back(0, period_);
        } else if (a + length <= period_) {
            part.emplace_back(a, a + length);
        } else {
            part.emplace_back(a, period_);
            part.emplace_back(0, a + length - period_);
        }
    }
    FieldRange found{1.0F, 0.0F};
    for (const auto& x : parts[0])
        for (const auto& y : parts[1])
            for (const auto& z : parts[2]) {
                const FieldRange part =
                    field_->range({x.first, y.first, z.first}, {x.second, y.second, z.second});
                found = {std::min(found.low, part.low), std::max(found.high, part.high)};
            }
    if (first != low || end != high) found.low = 0.0F;
    return found;
}

}  // namespace cairn::renderer
