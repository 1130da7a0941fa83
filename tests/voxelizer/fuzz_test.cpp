// Small sets of triangles at any level and in any region, the GPU against clipping (clipped_triangle.h). A
// longer trial:
//
//     CAIRN_FUZZ_TRIALS=100000 CAIRN_FUZZ_SEED=7 voxelizer_test --gtest_filter=VoxelizerFuzz.*
#include "tests/support/fuzz.h"

#include <gtest/gtest.h>

#include "shaders/interop/grid.h"
#include "tests/support/clipped_triangle.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::int64_t N = lattice_side;

/// Sets the voxels of a box of the region that the triangle meets, by halves.
void mark(const LatticeTriangle& triangle, const Region& region, const glm::ivec3& low,
          const glm::ivec3& size, BitGrid& bits) {
    const std::int64_t side = region.voxel_side();
    const glm::i64vec3 box_low = glm::i64vec3(region.origin + low) * side;
    if (!is_left_in_box<Int128>(triangle, box_low, box_low + glm::i64vec3(size) * side)) return;
    if (size == glm::ivec3(1)) {
        bits.set(low);
        return;
    }
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    glm::ivec3 first = size;
    first[axis] /= 2;
    glm::ivec3 middle = low;
    middle[axis] += first[axis];
    glm::ivec3 second = size;
    second[axis] -= first[axis];
    mark(triangle, region, low, first, bits);
    mark(triangle, region, middle, second, bits);
}

/// A region of mostly a few voxels per side; now and then long, or with more rows than one workgroup takes.
Region random_region(Random& random) {
    Region region;
    region.level = int(random.between(0, LATTICE_BITS));
    const std::int64_t kind = random.between(0, 40);
    region.size = glm::ivec3(random.point(1, 20));
    if (kind < 4) region.size[int(kind) % 3] = int(random.between(30, 1500));
    if (kind == 4) region.size = {int(random.between(1, 40)), 90, 90};
    const std::int64_t across = std::int64_t(1) << region.level;
    if (random.between(0, 9) > 0) {
        const std::int64_t most = std::max<std::int64_t>(across - 8, 0);
        region.origin = glm::ivec3(random.point(-4, most));
    } else {
        region.origin = glm::ivec3(random.point(-across - 4, 2 * across));  // as far as triangles reach
    }
    return region;
}

/// A triangle near the region, mostly within the shaders' range: as large as the region, as the cube, or far
/// larger.
LatticeTriangle triangle_near(Random& random, const Region& region) {
    const std::int64_t side = region.voxel_side();
    const glm::i64vec3 low = glm::i64vec3(region.origin) * side;
    const glm::i64vec3 high = glm::i64vec3(region.origin + region.size) * side;
    const auto point = [&] {
        glm::i64vec3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = random.between(low[axis] - 2 * side, high[axis] + 2 * side);
        return p;
    };
    LatticeTriangle t;
    const std::int64_t kind = random.between(0, 15);
    for (glm::i64vec3& p : t)
        p = kind < 4 ? random.point(-N, 2 * N) : point();
    if (kind == 0)
        t[2] = point() * std::int64_t(3) - t[0] - t[1];  // a large one through the region; far at times
    if (kind == 1) t[2] = t[0] = point();
    if (kind == 2) t[0] = point();
    if (kind == 4) t[2] = t[1];
    if (kind == 5) t[1] = t[2] = t[0];
    if (kind == 6) t[2] = t[1] * std::int64_t(2) - t[0] + random.point(-1, 1);
    if (kind == 7) t[2] = (t[0] + t[1]) / std::int64_t(2) + random.point(-1, 1);
    if (kind == 8) t = {t[0], t[0] + random.point(-3, 3), t[0] + random.point(-3, 3)};
    const std::int64_t snap = random.between(0, 3);
    for (glm::i64vec3& p : t) {
        for (int axis = 0; axis < 3; ++axis) {
            if (snap == 0 || (snap == 1 && random.between(0, 1) == 0)) p[axis] = p[axis] / side * side;
            if (snap < 2 && random.between(0, 5) == 0) p[axis] += random.between(-1, 1);
        }
    }
    if (kind == 9) {
        const int axis = int(random.between(0, 2));
        t[1][axis] = t[2][axis] = t[0][axis];
    }
    return t;
}

using VoxelizerFuzz = ConservativeTest;

TEST_F(VoxelizerFuzz, AnyTrianglesInAnyRegionAreExact) {
    const auto [seed, trials] = fuzz_of(51, 2000);
    Random random(seed);
    int filled = 0;
    for (std::int64_t trial = 0; trial < trials; ++trial) {
        const Region region = random_region(random);
        std::vector<LatticeTriangle> triangles;
        const std::int64_t count = random.between(1, 4);
        BitGrid truth(region.size);
        std::string described;
        for (std::int64_t i = 0; i < count; ++i) {
            triangles.push_back(triangle_near(random, region));
            mark(triangles.back(), region, glm::ivec3(0), region.size, truth);
            described += to_string(triangles.back()) + "; ";
        }
        filled += truth.count() > 0 ? 1 : 0;
        ASSERT_TRUE(same_bits(voxelize(triangles, region), truth))
            << fmt::format("seed {}, trial {}: level {}, origin {} {} {}, size {} {} {}: {}", seed, trial,
                           region.level, region.origin.x, region.origin.y, region.origin.z, region.size.x,
                           region.size.y, region.size.z, described);
    }
    EXPECT_GT(filled, trials / 2) << "most regions are empty: the trials say little";
}

}  // namespace
}  // namespace cairn::voxelizer
