// The index of a surface's triangles by region, against all boxes. CPU only. (Its lists by cell:
// triangle_index_test.cpp.)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/lattice_surface.h"
#include "voxelizer/surface/triangle_index.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

/// A surface without the triangles that miss the root cube, as build_surface() makes it.
void add_random(std::vector<LatticeTriangle>& triangles, Random& random, std::size_t count) {
    for (const std::size_t end = triangles.size() + count; triangles.size() < end;) {
        const LatticeTriangle t = random_triangle(random, lattice_side >> random.between(3, 12));
        const glm::i64vec3 low = glm::min(t[0], glm::min(t[1], t[2]));
        const glm::i64vec3 high = glm::max(t[0], glm::max(t[1], t[2]));
        if (glm::any(glm::lessThan(high, glm::i64vec3(0)))) continue;
        if (glm::any(glm::greaterThan(low, glm::i64vec3(lattice_side)))) continue;
        triangles.push_back(t);
    }
}

std::vector<std::uint32_t> brute_force(const TriangleIndex& index, std::size_t count, const Region& region) {
    const glm::i64vec3 low = glm::i64vec3(region.origin) * std::int64_t(region.voxel_side());
    const glm::i64vec3 high = low + glm::i64vec3(region.size) * std::int64_t(region.voxel_side());
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < count; ++i) {
        const TriangleIndex::Box& box = index.box(i);
        if (glm::any(glm::lessThan(glm::i64vec3(box.high), low)) ||
            glm::any(glm::greaterThan(glm::i64vec3(box.low), high))) {
            continue;
        }
        numbers.push_back(i);
    }
    return numbers;
}

/// A random region of any shape, which may reach outside the root cube, or lie outside.
Region random_region(Random& random) {
    Region region;
    region.level = int(random.between(0, 12));
    const std::int64_t across = std::int64_t(1) << region.level;
    region.origin = glm::ivec3(random.point(-2, across));
    for (int axis = 0; axis < 3; ++axis)
        region.size[axis] = int(random.between(1, random.between(0, 1) == 0 ? 3 : across));
    return region;
}

TEST(RegionIndex, RegionsHaveExactlyTheTrianglesWhoseBoxesMeetThem) {
    for (const int step : {1, 2, 3}) {
        for (const std::size_t held : {std::size_t(0), std::size_t(3000), std::size_t(1) << 20U}) {
            Random random(71);
            std::vector<LatticeTriangle> triangles;
            add_random(triangles, random, 800);
            TriangleIndex index(lattice_surface(triangles, 4096),
                                {.level_step = step, .border_shift = {}, .held_limit = held});
            std::size_t listed = 0;
            for (int i = 0; i < 300; ++i) {
                const Region region = random_region(random);
                const std::vector<std::uint32_t> truth = brute_force(index, triangles.size(), region);
                listed += truth.size();
                EXPECT_EQ(index.triangles_in(region), truth)
                    << fmt::format("step {}, held {}, level {}, origin ({} {} {}), size ({} {} {})", step,
                                   held, region.level, region.origin.x, region.origin.y, region.origin.z,
                                   region.size.x, region.size.y, region.size.z);
            }
            EXPECT_GT(listed, 1000U);
        }
    }
}

/// Adds small triangles in one eighth of an eighth of the cube.
std::vector<LatticeTriangle> crowd(std::size_t elsewhere) {
    Random random(72);
    std::vector<LatticeTriangle> triangles;
    const auto add = [&](std::int64_t low, std::int64_t high) {
        const glm::i64vec3 p = random.point(low, high);
        triangles.push_back({p, p + random.point(0, 3000), p + random.point(0, 3000)});
    };
    for (int i = 0; i < 5000; ++i)
        add(0, lattice_side / 8);
    for (std::size_t i = 0; i < elsewhere; ++i)
        add(lattice_side / 2, lattice_side - 4000);
    return triangles;
}

TEST(RegionIndex, ARegionCostsWhatItsOwnTrianglesCost) {
    std::vector<std::uint64_t> cost;
    std::vector<std::size_t> listed;
    for (const std::size_t elsewhere : {20'000, 250'000}) {
        TriangleIndex index(lattice_surface(crowd(elsewhere), 512));
        (void)index.triangles_in({9, glm::ivec3(400), glm::ivec3(64)});  // the root is split once
        const std::uint64_t before = index.entries_read();
        std::size_t count = 0;
        for (int x = 0; x < 4; ++x)
            count += index.triangles_in({9, glm::ivec3(16 * x, 8, 3), glm::ivec3(16)}).size();
        cost.push_back(index.entries_read() - before);
        listed.push_back(count);
    }
    EXPECT_EQ(listed[0], listed[1]);
    EXPECT_GT(listed[0], 50U);
    EXPECT_LT(double(cost[1]), 1.3 * double(cost[0])) << cost[0] << " entries read, then " << cost[1];
    EXPECT_LT(cost[0], 30'000U) << "refining 5000 triangles reads each a few times";
}

TEST(RegionIndex, FarTrianglesKeepTheirBoxes) {
    const glm::i64vec3 far_away(lattice_side * 5, 7, -9);
    const Surface surface = lattice_surface({{glm::i64vec3(1), glm::i64vec3(2), far_away}}, 64);
    const TriangleIndex index(surface);
    ASSERT_EQ(index.far_boxes().size(), 1U);
    EXPECT_EQ(index.triangle_count(), 0U);
    EXPECT_EQ(index.far_boxes()[0].low, glm::i64vec3(1, 1, -9));
    EXPECT_EQ(index.far_boxes()[0].high, glm::i64vec3(lattice_side * 5, 7, 2));
}

}  // namespace
}  // namespace cairn::voxelizer
