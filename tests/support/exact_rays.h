#pragma once

#include <functional>
#include <vector>

#include <glm/glm.hpp>

/// Rays through the set of renderer/produce/fractal_content.h in whole numbers: no quotient is rounded, so
/// times of crossings are compared exactly.
namespace cairn::test {

__extension__ using Wide = __int128;

struct WideVector {
    Wide x = 0, y = 0, z = 0;
    Wide& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    Wide operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

/// A cube of voxels that rays march. The next cube contains it.
struct Space {
    /// First voxel, in this space's voxels from the root cube's low corner.
    glm::i64vec3 low{0};
    std::int64_t side = 0;
    /// Log2 of a voxel's side, in voxels of the first space.
    int voxel_shift = 0;
    int bits = 0;        ///< log2 of the number of voxels across the root cube
    int step_shift = 0;  ///< log2 of the side of the largest cell to step over
};

struct ExactRay {
    /// In 2^-fraction_bits voxels of the first space, from the root cube's low corner.
    WideVector origin;
    glm::i64vec3 direction{0};
    int fraction_bits = 0;
};

/// An occupied voxel.
struct Crossed {
    int space = 0;
    glm::i64vec3 voxel{0};
};

/// Visits the occupied voxels along the ray, nearest first, until `visit` returns true. Each space
/// begins where the one before ends. A ray that meets an edge or a corner crosses x, then y, then z.
void cross_occupied(const std::vector<Space>& spaces, const ExactRay& ray,
                    const std::function<bool(const Crossed&)>& visit);

/// The part of the ray, as [first, last] of its parameter, in the voxel grown by `margin` of its sides
/// (shrunk if negative). In long double, relative to the origin. Empty if first > last.
struct Interval {
    long double first = 0.0L, last = -1.0L;
    [[nodiscard]] bool empty() const { return !(first <= last); }
};
[[nodiscard]] Interval inside(const std::vector<Space>& spaces, const ExactRay& ray, const Crossed& voxel,
                              long double margin);

}  // namespace cairn::test
