#include "voxelizer/grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::voxelizer {
namespace {

constexpr int max_resolution = 1 << LATTICE_BITS;

void check_resolution(int resolution) {
    if (resolution < 1 || resolution > max_resolution) {
        throw Error(Fault::usage, "grid", fmt::format("a resolution of {} is out of range", resolution),
                    fmt::format("choose 1 to {}", max_resolution));
    }
}

double longest_axis(const scenes::Bounds& bounds) {
    const glm::dvec3 size = bounds.high - bounds.low;
    return std::max({size.x, size.y, size.z});
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
        if (!(std::abs(units[axis]) <= LATTICE_WORLD_LIMIT)) {
            throw Error(Fault::input, "surface",
                        fmt::format("the point ({}, {}, {}) is too far from the grid, or not finite", world.x,
                                    world.y, world.z),
                        "choose a larger grid (--bounds)");
        }
        nearest[axis] = std::int64_t(std::floor(units[axis] + 0.5));
    }
    return nearest;
}

glm::dvec3 Grid::world_from_lattice(const glm::dvec3& lattice) const {
    return origin + lattice * lattice_unit();
}

Grid grid_around(const scenes::Bounds& bounds, int resolution) {
    check_resolution(resolution);
    if (bounds.empty()) return {glm::dvec3(0.0), 1.0 / resolution, glm::ivec3(resolution)};
    const glm::dvec3 centre = 0.5 * bounds.low + 0.5 * bounds.high;
    const double extent = longest_axis(bounds);
    // A little less than resolution - 2 voxels, so that the surface does not touch the border voxels even
    // after its vertices are rounded: contact counts.
    const double voxels = resolution < 3 ? resolution : resolution - 2 - 1.0 / 32;
    const double voxel_size = extent > 0.0 ? extent / voxels : 1.0 / resolution;
    return {centre - 0.5 * resolution * voxel_size, voxel_size, glm::ivec3(resolution)};
}

Grid grid_over(const scenes::Bounds& bounds, int resolution) {
    check_resolution(resolution);
    const double extent = bounds.empty() ? 0.0 : longest_axis(bounds);
    if (!(extent > 0.0) || !std::isfinite(extent)) {
        throw Error(Fault::usage, "grid", "the bounds span no volume",
                    "give a low corner under a high corner");
    }
    return {bounds.low, extent / resolution, glm::ivec3(resolution)};
}

Region whole(const Grid& grid) {
    return {grid.level(), glm::ivec3(0), grid.resolution};
}

}  // namespace cairn::voxelizer
