// The exact voxelizer on the CPU, which the charts compare with, and take for the truth where the reference
// is too slow.
#include <gtest/gtest.h>

#include "bench/peers/cpu_row_span.h"
#include "bench/plots/table.h"
#include "reference/exact_voxels.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "shaders/interop/grid.h"
#include "tests/support/lattice_surface.h"

namespace cairn::bench {
namespace {

using namespace cairn::test;
using voxelizer::BitGrid;
using voxelizer::Region;
using voxelizer::Surface;

/// Voxelizes into a grid full of bits that must be overwritten.
BitGrid row_spans(const Surface& surface, const Region& region) {
    BitGrid bits(region.size);
    std::fill(bits.words.begin(), bits.words.end(), ~0U);
    mark_row_spans(surface, region, bits);
    return bits;
}

TEST(CpuRowSpan, HasTheBitsOfTheExactReferenceForRandomTriangles) {
    constexpr std::uint32_t seed = 20260;
    Random random(seed);
    for (int level = 0; level <= LATTICE_BITS; level += level < 8 ? 1 : 4) {
        const Region region{level, glm::ivec3(0), glm::ivec3(std::min(1 << level, 37))};
        for (int i = 0; i < 300; ++i) {
            LatticeTriangle triangle = random_triangle(random, region.voxel_side());
            // The region of fine levels is only a corner of the cube: move the triangle there.
            if (level > 6) {
                const glm::i64vec3 shift = triangle[0] - random.point(0, 40 * region.voxel_side());
                for (glm::i64vec3& p : triangle)
                    p -= shift;
            }
            if (!within_shader_range(triangle[0]) || !within_shader_range(triangle[1]) ||
                !within_shader_range(triangle[2])) {
                continue;
            }
            const Surface surface = lattice_surface({triangle}, 1 << level);
            ASSERT_TRUE(same_bits(row_spans(surface, region), voxels_of(triangle, region)))
                << "seed " << seed << ", level " << level << ", triangle " << to_string(triangle);
        }
    }
}

TEST(CpuRowSpan, MarksAnyRegionAsItMarksTheWhole) {
    Random random(7);
    std::vector<LatticeTriangle> triangles;
    for (int i = 0; i < 200; ++i)
        triangles.push_back(random_triangle(random, lattice_side / 64));
    const Surface surface = lattice_surface(triangles, 64);
    const Region all{6, glm::ivec3(-5), glm::ivec3(75, 71, 79)};
    const BitGrid truth = reference::exact_voxels(surface, all);
    EXPECT_TRUE(same_bits(row_spans(surface, all), truth));
    const Region part{6, {9, 17, 23}, {33, 21, 5}};
    EXPECT_TRUE(same_bits(row_spans(surface, part), reference::exact_voxels(surface, part)));
}

class CpuRowSpanOf : public ::testing::TestWithParam<const char*> {};

TEST_P(CpuRowSpanOf, HasTheBitsOfTheExactReference) {
    const scenes::Scene scene = scenes::load(GetParam());
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    for (const int resolution : {33, 128, 256}) {
        const Surface surface =
            voxelizer::build_surface(scene, snapshot, voxelizer::grid_around(snapshot.bounds, resolution));
        const Region region = voxelizer::whole(surface.grid);
        EXPECT_TRUE(same_bits(row_spans(surface, region), reference::exact_voxels(surface, region)))
            << "resolution " << resolution;
    }
}

INSTANTIATE_TEST_SUITE_P(Builtin, CpuRowSpanOf,
                         ::testing::Values("builtin:knot", "builtin:spheres", "builtin:needles",
                                           "builtin:cornell"),
                         [](const auto& scene) { return std::string(scene.param + 8); });
#ifdef CAIRN_SCENE_DATA
INSTANTIATE_TEST_SUITE_P(Masked, CpuRowSpanOf,
                         ::testing::Values(CAIRN_SCENE_DATA
                                           "/asset-generator/Material_AlphaMask/Material_AlphaMask_01.gltf",
                                           CAIRN_SCENE_DATA "/gltf/big_and_tiny_triangles_quantized.glb"));
#endif

TEST(Table, WritesTextThatHoldsCommasAndQuotes) {
    const Table table{{"a", "b", "c"},
                      {{std::string("x, \"y\""), std::int64_t(3), 0.25}, {Cell{}, Cell{}, std::string("z")}}};
    EXPECT_EQ(csv_of(table), "a,b,c\n\"x, \"\"y\"\"\",3,0.25\n,,z\n");
}

}  // namespace
}  // namespace cairn::bench
