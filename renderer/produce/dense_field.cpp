#include "renderer/produce/dense_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "scenes/memory_budget.h"

namespace cairn::renderer {
namespace {

/// A voxel takes 2 bytes; the coarser levels and the bounds of boxes take less than one more.
constexpr std::uint64_t bytes_per_voxel = 3;
/// Samples that are far apart along one axis become many voxels. These may be so many times the samples, or
/// so many where the samples are few.
constexpr double most_voxels_per_sample = 64.0;
constexpr double few_voxels = 67108864.0;  // 2^26
constexpr float unit = 65535.0F;
constexpr int finest_bounds_shift = 2;

std::size_t place_in(const glm::i64vec3& size, std::int64_t x, std::int64_t y, std::int64_t z) {
    return std::size_t(x + size.x * (y + size.y * z));
}

/// Where the centre of each voxel lies among the samples along an axis: the sample before it, and the share
/// of the next sample.
struct Interpolation {
    std::vector<std::int64_t> before;
    std::vector<float> share;
};

Interpolation interpolation(std::int64_t voxels, std::int64_t samples, double samples_per_voxel) {
    Interpolation result;
    for (std::int64_t v = 0; v < voxels; ++v) {
        // Voxels on samples stay on them, whatever was rounded on the way.
        double place = (double(v) + 0.5) * samples_per_voxel - 0.5;
        if (std::abs(place - std::round(place)) < 1e-6) place = std::round(place);
        place = std::clamp(place, 0.0, double(samples - 1));
        const auto first = std::min(std::int64_t(place), std::max<std::int64_t>(samples - 2, 0));
        result.before.push_back(first);
        result.share.push_back(float(place - double(first)));
    }
    return result;
}

std::vector<std::uint16_t> resample(const scenes::Volume& volume, const FieldFrame& frame) {
    const glm::i64vec3 size = frame.size;
    const glm::i64vec3 from(volume.size);
    if (size == from && volume.spacing == glm::dvec3(frame.voxel_size)) return volume.samples;
    std::array<Interpolation, 3> along;
    for (int axis = 0; axis < 3; ++axis)
        along[std::size_t(axis)] =
            interpolation(size[axis], from[axis], frame.voxel_size / volume.spacing[axis]);
    std::vector<std::uint16_t> voxels(std::size_t(size.x * size.y * size.z));
    tbb::parallel_for(std::int64_t(0), size.z, [&](std::int64_t z) {
        const auto& xs = along[0];
        const auto& ys = along[1];
        const auto& zs = along[2];
        const std::int64_t z0 = zs.before[std::size_t(z)];
        const std::int64_t z1 = std::min(z0 + 1, from.z - 1);
        for (std::int64_t y = 0; y < size.y; ++y) {
            const std::int64_t y0 = ys.before[std::size_t(y)];
            const std::int64_t y1 = std::min(y0 + 1, from.y - 1);
            for (std::int64_t x = 0; x < size.x; ++x) {
                const std::int64_t x0 = xs.before[std::size_t(x)];
                const std::int64_t x1 = std::min(x0 + 1, from.x - 1);
                const auto row = [&](std::int64_t j, std::int64_t k) {
                    return std::lerp(float(volume.samples[place_in(from, x0, j, k)]),
                                     float(volume.samples[place_in(from, x1, j, k)]),
                                     xs.share[std::size_t(x)]);
                };
                const float fy = ys.share[std::size_t(y)];
                const float value =
                    std::lerp(std::lerp(row(y0, z0), row(y1, z0), fy),
                              std::lerp(row(y0, z1), row(y1, z1), fy), zs.share[std::size_t(z)]);
                voxels[place_in(size, x, y, z)] = std::uint16_t(std::lround(value));
            }
        }
    });
    return voxels;
}

}  // namespace

DenseField::DenseField(const scenes::Volume& volume, int n, std::optional<std::uint64_t> memory_bytes) {
    frame_.n = n;
    frame_.origin = volume.bounds().low;
    frame_.voxel_size = std::min({volume.spacing.x, volume.spacing.y, volume.spacing.z});
    const glm::dvec3 wide = volume.spacing * glm::dvec3(volume.size) / frame_.voxel_size;
    for (int axis = 0; axis < 3; ++axis)
        frame_.size[axis] =
            std::max<std::int64_t>(1, std::int64_t(std::ceil(std::min(wide[axis], 1e9) - 1e-6)));
    const std::string shape =
        fmt::format("{} x {} x {} cubic voxels", frame_.size.x, frame_.size.y, frame_.size.z);
    const double voxels = double(frame_.size.x) * double(frame_.size.y) * double(frame_.size.z);
    if (!memory_bytes &&
        voxels > std::max(few_voxels, most_voxels_per_sample * double(volume.samples.size()))) {
        throw Error(
            Fault::input, volume.name,
            fmt::format("its {} samples would become {}", volume.samples.size(), shape),
            "they are far apart along some axes only: resample it, or allow it by LoadOptions::memory_bytes");
    }
    scenes::MemoryBudget(memory_bytes.value_or(scenes::usual_memory_bytes))
        .charge(volume.name, shape, std::uint64_t(voxels), bytes_per_voxel);
    levels_.push_back({frame_.size, resample(volume, frame_)});
    while (std::max({levels_.back().size.x, levels_.back().size.y, levels_.back().size.z}) > 1) {
        const Level& fine = levels_.back();
        Level coarse;
        coarse.size = (fine.size + std::int64_t(n - 1)) / std::int64_t(n);
        coarse.means.resize(std::size_t(coarse.size.x * coarse.size.y * coarse.size.z));
        tbb::parallel_for(std::int64_t(0), coarse.size.z, [&](std::int64_t z) {
            for (std::int64_t y = 0; y < coarse.size.y; ++y) {
                for (std::int64_t x = 0; x < coarse.size.x; ++x) {
                    std::uint64_t sum = 0;
                    for (std::int64_t k = z * n; k < std::min((z + 1) * n, fine.size.z); ++k)
                        for (std::int64_t j = y * n; j < std::min((y + 1) * n, fine.size.y); ++j)
                            for (std::int64_t i = x * n; i < std::min((x + 1) * n, fine.size.x); ++i)
                                sum += fine.means[place_in(fine.size, i, j, k)];
                    const auto cells = std::uint64_t(n) * std::uint64_t(n) * std::uint64_t(n);
                    coarse.means[place_in(coarse.size, x, y, z)] = std::uint16_t((sum + cells / 2) / cells);
                }
            }
        });
        levels_.push_back(std::move(coarse));
    }
    build_bounds();
}

void DenseField::build_bounds() {
    const Level& finest = levels_.front();
    int shift = finest_bounds_shift;
    do {
        Bounds bounds;
        bounds.shift = shift;
        bounds.size = (finest.size + ((std::int64_t(1) << shift) - 1)) >> std::int64_t(shift);
        bounds.low_high.resize(std::size_t(bounds.size.x * bounds.size.y * bounds.size.z));
        const Bounds* finer = bounds_.empty() ? nullptr : &bounds_.back();
        const glm::i64vec3 from = finer != nullptr ? finer->size : finest.size;
        const std::int64_t step = finer != nullptr ? 2 : std::int64_t(1) << shift;
        tbb::parallel_for(std::int64_t(0), bounds.size.z, [&](std::int64_t z) {
            for (std::int64_t y = 0; y < bounds.size.y; ++y) {
                for (std::int64_t x = 0; x < bounds.size.x; ++x) {
                    std::array<std::uint16_t, 2> cell{std::numeric_limits<std::uint16_t>::max(), 0};
                    for (std::int64_t k = z * step; k < std::min((z + 1) * step, from.z); ++k)
                        for (std::int64_t j = y * step; j < std::min((y + 1) * step, from.y); ++j)
                            for (std::int64_t i = x * step; i < std::min((x + 1) * step, from.x); ++i) {
                                const std::size_t at = place_in(from, i, j, k);
                                const auto value = finer != nullptr
                                                       ? finer->low_high[at]
                                                       : std::array{finest.means[at], finest.means[at]};
                                cell = {std::min(cell[0], value[0]), std::max(cell[1], value[1])};
                            }
                    bounds.low_high[place_in(bounds.size, x, y, z)] = cell;
                }
            }
        });
        bounds_.push_back(std::move(bounds));
        ++shift;
    } while (std::max({bounds_.back().size.x, bounds_.back().size.y, bounds_.back().size.z}) > 1);
}

void DenseField::fill(int coarseness, const glm::i64vec3& low, const glm::ivec3& count, float* values) const {
    const std::size_t number = std::min(std::size_t(coarseness), levels_.size() - 1);
    const Level& level = levels_[number];
    // A voxel wider than the coarsest level held is empty outside that level.
    const double dilution = std::pow(double(frame_.n), -3.0 * double(std::size_t(coarseness) - number));
    const float scale = float(dilution) / unit;
    for (int z = 0; z < count.z; ++z) {
        for (int y = 0; y < count.y; ++y) {
            const glm::i64vec3 first = low + glm::i64vec3(0, y, z);
            const bool outside =
                first.y < 0 || first.z < 0 || first.y >= level.size.y || first.z >= level.size.z;
            for (int x = 0; x < count.x; ++x) {
                const std::int64_t i = first.x + x;
                *values++ = outside || i < 0 || i >= level.size.x
                                ? 0.0F
                                : float(level.means[place_in(level.size, i, first.y, first.z)]) * scale;
            }
        }
    }
}

FieldRange DenseField::range(const glm::i64vec3& low, const glm::i64vec3& high) const {
    const glm::i64vec3 first = glm::max(low, glm::i64vec3(0));
    const glm::i64vec3 last = glm::min(high, frame_.size) - std::int64_t(1);
    if (glm::any(glm::lessThan(last, first))) return {};
    const bool reaches_out = first != low || last + std::int64_t(1) != high;
    // Cells of about a quarter of the box: few to look at, and not much more than the box.
    const std::int64_t side = std::max({last.x - first.x, last.y - first.y, last.z - first.z});
    std::size_t number = 0;
    while (number + 1 < bounds_.size() && (std::int64_t(4) << bounds_[number].shift) < side)
        ++number;
    const Bounds& bounds = bounds_[number];
    std::array<std::uint16_t, 2> found{std::numeric_limits<std::uint16_t>::max(), 0};
    const glm::i64vec3 a = first >> std::int64_t(bounds.shift);
    const glm::i64vec3 b = last >> std::int64_t(bounds.shift);
    for (std::int64_t z = a.z; z <= b.z; ++z)
        for (std::int64_t y = a.y; y <= b.y; ++y)
            for (std::int64_t x = a.x; x <= b.x; ++x) {
                const auto& cell = bounds.low_high[place_in(bounds.size, x, y, z)];
                found = {std::min(found[0], cell[0]), std::max(found[1], cell[1])};
            }
    return {reaches_out ? 0.0F : float(found[0]) / unit, float(found[1]) / unit};
}

}  // namespace cairn::renderer
