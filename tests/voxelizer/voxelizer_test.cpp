// The conservative method on hand-made triangles: against every voxel of a small region, one triangle at a
// time.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "base/error.h"
#include "gl/limits.h"
#include "shaders/interop/grid.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/voxelizer_fixture.h"
#include "voxelizer/methods/conservative_voxelizer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

constexpr std::int64_t N = lattice_side;

class VoxelizerTest : public ConservativeTest {
protected:
    /// Checks that each triangle alone has exactly the voxels that it meets.
    void expect_exact(const std::vector<LatticeTriangle>& triangles, const Region& region) {
        std::vector<LatticeTriangle> near;
        for (const LatticeTriangle& t : triangles) {
            if (std::all_of(t.begin(), t.end(), within_shader_range)) near.push_back(t);
        }
        const GpuSurface surface = upload(lattice_surface(near, 16));
        std::uint32_t number = 0;
        for (const LatticeTriangle& t : near) {
            const std::uint32_t subset[] = {number++};
            EXPECT_TRUE(same_bits(voxelizer().voxelize(surface, region, subset), voxels_of(t, region)))
                << to_string(t) << "level " << region.level;
        }
    }

private:
    std::optional<ConservativeVoxelizer> voxelizer_;
};

const Region sixteen{4, glm::ivec3(0), glm::ivec3(16)};
constexpr std::int64_t voxel = N / 16;  // lattice units per voxel of `sixteen`

/// The same triangles with the axes exchanged in all six ways, and mirrored.
std::vector<LatticeTriangle> turned(const std::vector<LatticeTriangle>& triangles) {
    std::vector<LatticeTriangle> out;
    for (const LatticeTriangle& t : triangles) {
        for (const glm::ivec3& order : {glm::ivec3(0, 1, 2), glm::ivec3(1, 2, 0), glm::ivec3(2, 0, 1),
                                        glm::ivec3(0, 2, 1), glm::ivec3(2, 1, 0), glm::ivec3(1, 0, 2)}) {
            for (const bool mirrored : {false, true}) {
                LatticeTriangle& turned = out.emplace_back();
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    for (int axis = 0; axis < 3; ++axis)
                        turned[corner][axis] = t[corner][order[axis]];
                    if (mirrored) turned[corner] = N - turned[corner];
                }
            }
        }
    }
    return out;
}

TEST_F(VoxelizerTest, FacesOnVoxelPlanesTouchBothSides) {
    const std::int64_t a = 3 * voxel;
    const std::int64_t b = 9 * voxel;
    expect_exact(turned({{glm::i64vec3(a, a, a), glm::i64vec3(b, a, a), glm::i64vec3(a, b, a)},
                         {glm::i64vec3(a, a, a + 1), glm::i64vec3(b, a, a + 1), glm::i64vec3(a, b, a + 1)},
                         {glm::i64vec3(a, a, a - 1), glm::i64vec3(b, a, a - 1), glm::i64vec3(a, b, a - 1)}}),
                 sixteen);
}

TEST_F(VoxelizerTest, EdgesAndVerticesOnVoxelPlanesTouchAllNeighbours) {
    const std::int64_t a = 5 * voxel;
    expect_exact(
        turned(
            {{glm::i64vec3(a), glm::i64vec3(a + voxel), glm::i64vec3(a, a + voxel, a + 7)},
             {glm::i64vec3(a), glm::i64vec3(a + 3 * voxel, a, a), glm::i64vec3(a + 11, a + 9, a + 2 * voxel)},
             {glm::i64vec3(a), glm::i64vec3(a + 4 * voxel), glm::i64vec3(a + 4 * voxel, a, a)},
             {glm::i64vec3(a), glm::i64vec3(a), glm::i64vec3(a)},
             {glm::i64vec3(a), glm::i64vec3(a, a, a + 2 * voxel), glm::i64vec3(a, a, a + 2 * voxel)}}),
        sixteen);
}

TEST_F(VoxelizerTest, DiagonalPlanesThroughVoxelCornersAreClosed) {
    // x + y + z = constant through corners, and one unit to either side: ties in the dominant axis of the
    // normal.
    std::vector<LatticeTriangle> triangles;
    for (const std::int64_t offset : {-1, 0, 1}) {
        const std::int64_t a = 6 * voxel + offset;
        triangles.push_back(
            {glm::i64vec3(a, voxel, voxel), glm::i64vec3(voxel, a, voxel), glm::i64vec3(voxel, voxel, a)});
        triangles.push_back({glm::i64vec3(a, 0, 0), glm::i64vec3(0, a, 0), glm::i64vec3(a, 0, 5 * voxel)});
    }
    expect_exact(turned(triangles), sixteen);
}

TEST_F(VoxelizerTest, VerticesAtTheEndsOfTheGridCount) {
    expect_exact(turned({{glm::i64vec3(0), glm::i64vec3(N), glm::i64vec3(0, N, 0)},
                         {glm::i64vec3(0, 0, N), glm::i64vec3(N, 0, N), glm::i64vec3(0, N, N)},
                         {glm::i64vec3(N), glm::i64vec3(N), glm::i64vec3(N)}}),
                 sixteen);
}

TEST_F(VoxelizerTest, TrianglesOutsideTouchingAndEnclosingTheRegion) {
    expect_exact(turned({{glm::i64vec3(-N, -N, -1), glm::i64vec3(2 * N, -N, -1), glm::i64vec3(-N, 2 * N, -1)},
                         {glm::i64vec3(-N, -N, 0), glm::i64vec3(2 * N, -N, 0), glm::i64vec3(-N, 2 * N, 0)},
                         {glm::i64vec3(-N, -N, 7 * voxel + 5), glm::i64vec3(2 * N, -N, 7 * voxel),
                          glm::i64vec3(-N, 2 * N, 9)},
                         {glm::i64vec3(-N, N, N), glm::i64vec3(N, -N, N), glm::i64vec3(N, N, -N)},
                         {glm::i64vec3(-N), glm::i64vec3(2 * N), glm::i64vec3(2 * N, 2 * N, 2 * N - 1)}}),
                 sixteen);
}

TEST_F(VoxelizerTest, DegenerateTrianglesAreSegmentsAndPoints) {
    const glm::i64vec3 p(5 * voxel + 3, 6 * voxel + 17, 7 * voxel + 29);
    const glm::i64vec3 d(3 * voxel + 1, -2 * voxel + 5, 4 * voxel - 7);
    expect_exact(turned({{p, p, p},
                         {p, p + d, p + d},
                         {p, p + d, p},
                         {p, p + d, p + d * std::int64_t(2)},  // no area, three places
                         {p + d, p, p + d * std::int64_t(2)},
                         {p, p + glm::i64vec3(9 * voxel, 0, 0), p + glm::i64vec3(2 * voxel, 0, 0)},
                         {p, p + glm::i64vec3(0, 0, 1), p}}),
                 sixteen);
}

TEST_F(VoxelizerTest, NeedlesAndSubVoxelTrianglesAreNotLost) {
    Random random(11);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 40; ++i) {
        const glm::i64vec3 a = random.point(0, N);
        const glm::i64vec3 b = random.point(0, N);
        triangles.push_back({a, b, (a + b) / std::int64_t(2) + random.point(-2, 2)});
        triangles.push_back({a, a + random.point(-3, 3), a + random.point(-3, 3)});
    }
    expect_exact(triangles, sixteen);
}

TEST_F(VoxelizerTest, TrianglesAlmostParallelToAnAxisAreExact) {
    Random random(12);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 20; ++i) {
        LatticeTriangle t = {random.point(0, N), random.point(0, N), random.point(0, N)};
        const std::int64_t plane = random.between(0, 16) * voxel;
        for (glm::i64vec3& p : t)
            p.y = plane + random.between(-1, 1);
        triangles.push_back(t);
    }
    expect_exact(turned(triangles), {4, glm::ivec3(0), glm::ivec3(16)});
}

TEST_F(VoxelizerTest, RandomTrianglesAreExactAtManyLevels) {
    Random random(13);
    for (const Region& region :
         {Region{0, glm::ivec3(-1), glm::ivec3(3)}, Region{3, glm::ivec3(-1), glm::ivec3(10)},
          Region{4, glm::ivec3(0), glm::ivec3(16)}, Region{5, {3, -2, 11}, {29, 17, 13}},
          Region{9, {250, 240, 260}, {33, 12, 9}}}) {
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 150; ++i)
            triangles.push_back(random_triangle(random, region.voxel_side()));
        expect_exact(triangles, region);
    }
}

TEST_F(VoxelizerTest, DeepLevelsAreExact) {
    // Where a voxel is one to sixteen lattice units, every row is in doubt.
    Random random(14);
    for (const int level : {20, 22, 23, 24}) {
        const std::int64_t side = std::int64_t(1) << (LATTICE_BITS - level);
        const glm::i64vec3 middle(N / 2 + 12345);
        const Region region{level, glm::ivec3(middle / side) - 8, glm::ivec3(16)};
        std::vector<LatticeTriangle> triangles;
        for (int i = 0; i < 60; ++i) {
            const std::int64_t reach = i % 2 == 0 ? 12 * side : N;
            triangles.push_back({middle + random.point(-reach, reach), middle + random.point(-reach, reach),
                                 middle + random.point(-reach, reach) / std::int64_t(i % 3 + 1)});
        }
        expect_exact(triangles, region);
    }
}

TEST_F(VoxelizerTest, TrianglesTooWideForFloatsAreExact) {
    // Sides of more than 2^24 units through small voxels in the middle of them.
    Random random(18);
    for (const int level : {4, 14, 20, 24}) {
        const std::int64_t side = std::int64_t(1) << (LATTICE_BITS - level);
        std::vector<LatticeTriangle> triangles;
        const glm::i64vec3 middle(N / 2 + 7);
        const Region region{level, glm::ivec3(middle / side) - 6, glm::ivec3(12)};
        for (int i = 0; i < 60; ++i) {
            const glm::i64vec3 a = random.point(-N, 2 * N);
            const glm::i64vec3 b = random.point(-N, 2 * N);
            triangles.push_back({a, b,
                                 glm::clamp(middle * std::int64_t(3) - a - b + random.point(-9, 9) * side,
                                            glm::i64vec3(-N), glm::i64vec3(2 * N))});
        }
        expect_exact(triangles, region);
    }
}

TEST_F(VoxelizerTest, TrianglesFarBeyondTheCubeAreExact) {
    Random random(15);
    for (int i = 0; i < 60; ++i) {
        const std::int64_t reach = (std::int64_t(1) << 38) >> (i % 13);
        LatticeTriangle t = {random.point(-reach, reach), random.point(-reach, reach),
                             random.point(-reach, reach)};
        // Its plane passes near the cube.
        t[2] = -t[0] - t[1] + random.point(0, N);
        if (i % 5 == 0) t[1].x = t[0].x;
        if (i % 7 == 0) t[2] = t[1];
        EXPECT_TRUE(same_bits(voxelize({t}, sixteen), voxels_of(t, sixteen))) << to_string(t);
    }
}

TEST_F(VoxelizerTest, OppositeVertexOrdersGiveTheSameBits) {
    Random random(16);
    for (int i = 0; i < 30; ++i) {
        const LatticeTriangle t = random_triangle(random, voxel);
        const BitGrid bits = voxelize({t}, sixteen);
        EXPECT_EQ(bits, voxelize({{t[1], t[0], t[2]}}, sixteen)) << to_string(t);
        EXPECT_EQ(bits, voxelize({{t[2], t[0], t[1]}}, sixteen)) << to_string(t);
    }
}

TEST_F(VoxelizerTest, SubdivisionDoesNotChangeTheUnion) {
    Random random(17);
    for (int i = 0; i < 30; ++i) {
        LatticeTriangle t = random_triangle(random, voxel);
        if (!within_shader_range(t[0] * std::int64_t(2))) continue;
        for (glm::i64vec3& p : t)
            p = p / std::int64_t(2) * std::int64_t(2);  // the middles of its sides are on the lattice
        const auto middle = [&](int a, int b) {
            return (t[std::size_t(a)] + t[std::size_t(b)]) / std::int64_t(2);
        };
        const glm::i64vec3 ab = middle(0, 1);
        const glm::i64vec3 bc = middle(1, 2);
        const glm::i64vec3 ca = middle(2, 0);
        const BitGrid parts =
            voxelize({{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}, sixteen);
        EXPECT_TRUE(same_bits(parts, voxelize({t}, sixteen))) << to_string(t);
        // A T-junction: one side split, the other triangle's not.
        const BitGrid halves = voxelize({{t[0], ab, t[2]}, {ab, t[1], t[2]}}, sixteen);
        EXPECT_TRUE(same_bits(halves, voxelize({t}, sixteen))) << to_string(t);
    }
}

TEST_F(VoxelizerTest, OneTriangleAcrossALargeGridIsExact) {
    // Larger than one thread's share and than one workgroup's.
    const Region region{8, glm::ivec3(0), glm::ivec3(256)};
    for (const LatticeTriangle& t :
         {LatticeTriangle{glm::i64vec3(5, 9, N - 3), glm::i64vec3(N, 77, N / 3),
                          glm::i64vec3(N / 5, N - 1, 0)},
          LatticeTriangle{glm::i64vec3(0, 0, N / 2), glm::i64vec3(N, 0, N / 2), glm::i64vec3(0, N, N / 2)},
          LatticeTriangle{glm::i64vec3(N / 2, 0, 0), glm::i64vec3(N / 2, N, 1), glm::i64vec3(N / 2, 3, N)}}) {
        const Surface surface = lattice_surface({t}, 256);
        EXPECT_TRUE(same_bits(voxelizer().voxelize(upload(surface), region),
                              reference::exact_voxels(surface, region)))
            << to_string(t);
    }
}

TEST_F(VoxelizerTest, NothingIsMarkedWithoutTriangles) {
    EXPECT_EQ(voxelize({}, sixteen).count(), 0U);
    Surface none;
    none.grid = unit_grid(16);
    none.materials.resize(1);
    EXPECT_EQ(voxelizer().voxelize(upload(none), sixteen).count(), 0U);
}

TEST_F(VoxelizerTest, RegionsPastTheDriversLimitAreRefusedWithWhatWouldFit) {
    const GpuSurface surface = upload(lattice_surface({}, 16));
    try {
        (void)voxelizer().voxelize(surface, {14, glm::ivec3(0), glm::ivec3(16384)});
        FAIL() << "2^42 bits fit";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::memory);
        EXPECT_NE(error.way_out().find("would fit"), std::string::npos) << error.way_out();
    }
    EXPECT_THROW((void)voxelizer().voxelize(surface, {16, glm::ivec3(0), {1 << 16, 1, 1}}), Error);
    EXPECT_THROW((void)voxelizer().voxelize(surface, {25, glm::ivec3(0), glm::ivec3(1)}), Error);
    EXPECT_THROW((void)voxelizer().voxelize(surface, {4, glm::ivec3(0), {4, 0, 4}}), Error);
}

/// Triangles that fill a grid with all sizes.
std::vector<LatticeTriangle> many_triangles(int count, std::uint32_t seed) {
    Random random(seed);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < count; ++i)
        triangles.push_back(random_triangle(random, N / 64));
    return triangles;
}

TEST_F(VoxelizerTest, EveryTilingGivesTheBitsOfTheWhole) {
    const GpuSurface surface = upload(lattice_surface(many_triangles(40, 21), 64));
    const Region all{6, glm::ivec3(0), glm::ivec3(64)};
    const BitGrid whole_bits = voxelizer().voxelize(surface, all);
    for (const glm::ivec3& tile :
         {glm::ivec3(32), glm::ivec3(16, 64, 5), glm::ivec3(7, 33, 64), glm::ivec3(18)}) {
        BitGrid assembled(all.size);
        for (int z = 0; z < 64; z += tile.z) {
            for (int y = 0; y < 64; y += tile.y) {
                for (int x = 0; x < 64; x += tile.x) {
                    const glm::ivec3 low(x, y, z);
                    const Region part{6, low, glm::min(tile, 64 - low)};
                    const BitGrid bits = voxelizer().voxelize(surface, part);
                    for (int c = 0; c < part.size.z; ++c)
                        for (int b = 0; b < part.size.y; ++b)
                            for (int a = 0; a < part.size.x; ++a)
                                if (bits.at({a, b, c})) assembled.set(low + glm::ivec3(a, b, c));
                }
            }
        }
        EXPECT_TRUE(same_bits(assembled, whole_bits))
            << fmt::format("tiles of {} {} {}", tile.x, tile.y, tile.z);
    }
}

TEST_F(VoxelizerTest, EachLevelIsTheOrOfTheFinerOneAndOfItself) {
    const GpuSurface surface = upload(lattice_surface(many_triangles(60, 22), 128));
    BitmaskPyramid pyramid = voxelizer().voxelize_pyramid(surface, {7, glm::ivec3(0), glm::ivec3(128)});
    ASSERT_EQ(pyramid.level_count(), 8);
    for (int level = 0; level < 8; ++level) {
        const Region region{7 - level, glm::ivec3(0), glm::ivec3(128 >> level)};
        EXPECT_TRUE(same_bits(pyramid.level(level), voxelizer().voxelize(surface, region)))
            << "level " << level;
    }
}

TEST_F(VoxelizerTest, PyramidsOfOddSizesRoundUp) {
    const GpuSurface surface = upload(lattice_surface(many_triangles(30, 23), 128));
    for (const glm::ivec3& size :
         {glm::ivec3(1), glm::ivec3(3), glm::ivec3(33), glm::ivec3(100, 7, 65), glm::ivec3(31, 32, 64)}) {
        const Region region{7, {5, 9, 20}, size};
        const BitmaskPyramid ours = voxelizer().voxelize_pyramid(surface, region);
        const BitmaskPyramid truth = build_pyramid(voxelizer().voxelize(surface, region));
        ASSERT_EQ(ours.level_count(), truth.level_count());
        glm::ivec3 expected = size;
        for (int level = 0; level < ours.level_count(); ++level, expected = (expected + 1) / 2) {
            EXPECT_EQ(ours.level(level).size, expected);
            EXPECT_TRUE(same_bits(ours.level(level), truth.level(level))) << "level " << level;
        }
        EXPECT_EQ(ours.level(ours.level_count() - 1).size, glm::ivec3(1));
    }
}

TEST_F(VoxelizerTest, OddResolutionsAreExact) {
    for (const int resolution : {1, 2, 3, 31, 33, 100}) {
        const Surface surface = lattice_surface(many_triangles(30, 24), resolution);
        const Region region = whole(surface.grid);
        EXPECT_TRUE(same_bits(voxelizer().voxelize(upload(surface), region),
                              reference::exact_voxels(surface, region)))
            << "resolution " << resolution;
    }
}

TEST_F(VoxelizerTest, RunsGiveTheSameBits) {
    const GpuSurface surface = upload(lattice_surface(many_triangles(300, 25), 128));
    const Region region{7, glm::ivec3(0), glm::ivec3(128)};
    const BitGrid first = voxelizer().voxelize(surface, region);
    for (int run = 0; run < 5; ++run)
        ASSERT_EQ(voxelizer().voxelize(surface, region), first) << "run " << run;
    ConservativeVoxelizer other;
    EXPECT_EQ(other.voxelize(surface, region), first);
}

TEST_F(VoxelizerTest, SubsetsMarkOnlyTheirTriangles) {
    const std::vector<LatticeTriangle> triangles = many_triangles(50, 26);
    const GpuSurface surface = upload(lattice_surface(triangles, 64));
    const Region region{6, glm::ivec3(0), glm::ivec3(64)};
    std::vector<std::uint32_t> odd;
    std::vector<LatticeTriangle> only_odd;
    for (std::uint32_t i = 1; i < 50; i += 2) {
        odd.push_back(i);
        only_odd.push_back(triangles[i]);
    }
    EXPECT_TRUE(same_bits(voxelizer().voxelize(surface, region, odd), voxelize(only_odd, region)));
    EXPECT_EQ(voxelizer().voxelize(surface, region, std::span<const std::uint32_t>()).count(), 0U);
    std::vector<std::uint32_t> all(50);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(voxelizer().voxelize(surface, region, all), voxelizer().voxelize(surface, region));
}

}  // namespace
}  // namespace cairn::voxelizer
