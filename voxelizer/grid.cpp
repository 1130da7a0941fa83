#include "voxelizer/grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/grid.h"

namespace cairn::voxelizer {
namespace {

static_assert(lattice_bits == LATTICE_BITS && lattice_world_limit == LATTICE_WORLD_LIMIT,
              "the shaders have another lattice");

void check_resolution(const glm::ivec3& resolution) {
    for (int axis = 0; axis < 3; ++axis) {
        if (resolution[axis] < 1 || resolution[axis] > MAX_GRID_RESOLUTION) {
            throw Error(Fault::usage, "grid",
                        fmt::format("a resolution of {} is out of range", resolution[axis]),
                        fmt::format("choose 1 to {}", MAX_GRID_RESOLUTION));
        }
    }
}

/// The least voxel size at which `voxels` voxels hold the extent, along every axis.
double least_voxel_size(const glm::dvec3& extent, const glm::dvec3& voxels) {
    const glm::dvec3 sizes = extent / voxels;
    return std::max({sizes.x, sizes.y, sizes.z});
}

void check_volume(const scenes::Bounds& bounds) {
    const glm::dvec3 extent = bounds.empty() ? glm::dvec3(0.0) : bounds.high - bounds.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (longest > 0.0 && std::isfinite(longest)) return;
    throw Error(Fault::usage, "grid", "the bounds span no volume", "give a low corner under a high corner");
}

/// A little space beside whole voxels, so that the surface does not touch the border voxels even after its
/// vertices are rounded: contact counts.
constexpr double slack = 1.0 / 32;

/// ceil(extent / voxel_size) + extra, within [1, limit].
glm::ivec3 voxels_over(const glm::dvec3& extent, double voxel_size, double extra, int limit) {
    if (!(voxel_size > 0.0) || !std::isfinite(voxel_size)) {
        throw Error(Fault::usage, "voxel size", fmt::format("{} is not above 0", voxel_size));
    }
    // The rounding error of a quotient of doubles must not add a voxel: 1.1 / 0.1 is 11.000000000000002.
    const glm::dvec3 voxels =
        glm::max(glm::ceil(extent / voxel_size * (1.0 - 0x1p-40)) + extra, glm::dvec3(1.0));
    if (glm::all(glm::lessThanEqual(voxels, glm::dvec3(limit)))) return voxels;
    const double longest = std::max({extent.x, extent.y, extent.z});
    throw Error(Fault::usage, "voxel size",
                fmt::format("voxels of {} make {:.0f} x {:.0f} x {:.0f}, more than {} along an axis",
                            voxel_size, voxels.x, voxels.y, voxels.z, limit),
                fmt::format("{:.4g} would fit", longest / (limit - extra - 1.0) * 1.001));
}

}  // namespace

int Grid::level() const {
    const int longest = std::max({resolution.x, resolution.y, resolution.z, 1});
    return std::bit_width(unsigned(longest - 1));
}

double Grid::lattice_unit() const {
    return std::ldexp(voxel_size, level() - LATTICE_BITS);
}

double Grid::lattice_scale() const {
    return 1.0 / lattice_unit();
}

glm::i64vec3 Grid::lattice_from_world(const glm::dvec3& world) const {
    const glm::dvec3 units = (world - origin) * lattice_scale();
    glm::i64vec3 nearest;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(units[axis]) <= lattice_world_limit)) {
            const bool is_finite = std::isfinite(world.x) && std::isfinite(world.y) && std::isfinite(world.z);
            throw Error(is_finite ? Fault::usage : Fault::input, "surface",
                        fmt::format("the point ({}, {}, {}) is {}", world.x, world.y, world.z,
                                    is_finite ? "too far from so small a grid" : "not finite"),
                        is_finite ? "choose a larger grid (grid_over())" : "");
        }
        nearest[axis] = std::int64_t(std::floor(units[axis] + 0.5));
    }
    return nearest;
}

Grid grid_around(const scenes::Bounds& bounds, const glm::ivec3& resolution) {
    check_resolution(resolution);
    const int longest = std::max({resolution.x, resolution.y, resolution.z});
    if (bounds.empty()) return {glm::dvec3(0.0), 1.0 / longest, resolution};
    const glm::dvec3 centre = 0.5 * bounds.low + 0.5 * bounds.high;
    glm::dvec3 voxels(resolution);
    for (int axis = 0; axis < 3; ++axis) {
        if (resolution[axis] >= 3) voxels[axis] -= 2.0 + slack;
    }
    const double least = least_voxel_size(bounds.high - bounds.low, voxels);
    const double voxel_size = least > 0.0 ? least : 1.0 / longest;
    return {centre - 0.5 * glm::dvec3(resolution) * voxel_size, voxel_size, resolution};
}

Grid grid_over(const scenes::Bounds& bounds, const glm::ivec3& resolution) {
    check_resolution(resolution);
    check_volume(bounds);
    return {bounds.low, least_voxel_size(bounds.high - bounds.low, glm::dvec3(resolution)), resolution};
}

Grid grid_of_voxels_around(const scenes::Bounds& bounds, double voxel_size, int limit) {
    if (bounds.empty())
        return {glm::dvec3(0.0), voxel_size, voxels_over(glm::dvec3(0.0), voxel_size, 1.0, limit)};
    const glm::dvec3 extent = bounds.high - bounds.low;
    const glm::ivec3 resolution = voxels_over(extent + slack * voxel_size, voxel_size, 2.0, limit);
    const glm::dvec3 centre = 0.5 * bounds.low + 0.5 * bounds.high;
    return {centre - 0.5 * glm::dvec3(resolution) * voxel_size, voxel_size, resolution};
}

Grid grid_of_voxels_over(const scenes::Bounds& bounds, double voxel_size, int limit) {
    check_volume(bounds);
    return {bounds.low, voxel_size, voxels_over(bounds.high - bounds.low, voxel_size, 0.0, limit)};
}

Region whole(const Grid& grid) {
    return {grid.level(), glm::ivec3(0), grid.resolution};
}

}  // namespace cairn::voxelizer
