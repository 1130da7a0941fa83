// Colours and normals of voxels against an integral over clipped polygons (attribute_truth.h).
#include "voxelizer/methods/voxel_attributes.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <gtest/gtest.h>

#include "tests/support/attribute_truth.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/painted.h"
#include "voxelizer/files/voxel_tiles.h"
#include "voxelizer/methods/conservative_voxelizer.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

class VoxelAttributesTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        marker_.emplace();
        painter_.emplace();
    }
    void TearDown() override {
        marker_.reset();
        painter_.reset();
        GlTest::TearDown();
    }
    struct Result {
        BitGrid bits;
        VoxelAttributes attributes;
    };
    Result gather(const Painted& painted, const Grid& grid, std::optional<Region> region = std::nullopt) {
        const GpuSurface surface = upload(painted.surface(grid));
        const Region part = region.value_or(whole(grid));
        Result result{marker_->voxelize(surface, part), {}};
        result.attributes = painter_->gather(surface, part, result.bits);
        return result;
    }
    /// Checks that every voxel with more than a speck of surface agrees with the integral.
    static void expect_true(const Result& result, const std::vector<TruthTriangle>& triangles,
                            const glm::ivec3& origin, double color_error, double degrees);

    std::optional<ConservativeVoxelizer> marker_;
    std::optional<AttributeVoxelizer> painter_;
};

void VoxelAttributesTest::expect_true(const Result& result, const std::vector<TruthTriangle>& triangles,
                                      const glm::ivec3& origin, double color_error, double degrees) {
    const std::vector<TruthVoxel> truth = true_attributes(triangles, result.bits, origin);
    ASSERT_EQ(result.attributes.colors.size(), truth.size());
    ASSERT_EQ(result.attributes.normals.size(), truth.size());
    double worst_color = 0.0;
    double worst_angle = 0.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i].area < 1e-7) continue;
        ++compared;
        const glm::dvec3 off =
            glm::abs(glm::dvec3(result.attributes.colors[i]) - truth[i].color / truth[i].area);
        worst_color = std::max({worst_color, off.x, off.y, off.z});
        // Where normals nearly cancel, the mean has no direction to speak of.
        if (glm::length(truth[i].normal) < 0.1 * truth[i].area) continue;
        const double cosine =
            glm::dot(glm::dvec3(result.attributes.normals[i]), glm::normalize(truth[i].normal));
        worst_angle = std::max(worst_angle, glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
    }
    EXPECT_GT(compared, truth.size() * 9 / 10);
    EXPECT_LE(worst_color * 255.0, color_error) << "of 255, over " << compared << " voxels";
    EXPECT_LE(worst_angle, degrees) << "degrees, over " << compared << " voxels";
}

TEST_F(VoxelAttributesTest, VertexColoursAndNormalsAreTheMeanOverTheClippedTriangles) {
    for (const std::uint32_t seed : {1U, 2U}) {
        SCOPED_TRACE(seed);
        Painted painted = random_triangles(seed, 150, true);
        painted.scene.materials[0].base_color = {0.9F, 0.5F, 1.0F, 1.0F};
        expect_true(gather(painted, unit_cube(32)), painted.truth(unit_cube(32)), {}, 1.0, 1.0);
    }
}

TEST_F(VoxelAttributesTest, WithoutVertexNormalsTheTrianglesOwnCount) {
    const Painted painted = random_triangles(3, 150, false);
    expect_true(gather(painted, unit_cube(32)), painted.truth(unit_cube(32)), {}, 1.0, 1.0);
}

TEST_F(VoxelAttributesTest, TexturesAreAveragedInLinearSpace) {
    Painted painted = random_triangles(4, 60, true);
    painted.use_image(96, 96, smooth_image(96), scenes::AlphaMode::opaque);
    for (const int resolution : {16, 64}) {
        SCOPED_TRACE(resolution);
        expect_true(gather(painted, unit_cube(resolution)), painted.truth(unit_cube(resolution)), {}, 1.0,
                    1.0);
    }
}

TEST_F(VoxelAttributesTest, DeepVoxelsOfLargeTrianglesAreAsExact) {
    Painted painted = random_triangles(5, 40, true);
    for (glm::vec3& position : painted.primitive.positions)
        position = (position - 0.5F) * 1.6F + 0.5F;
    Grid grid = unit_cube(1 << 16);
    Region region = whole(grid);
    // Around a corner of a triangle, where voxels are 1/65536 of its size.
    const auto corner = std::ranges::find_if(painted.primitive.positions, [](const glm::vec3& p) {
        return glm::all(glm::greaterThan(p, glm::vec3(0.1F))) && glm::all(glm::lessThan(p, glm::vec3(0.9F)));
    });
    ASSERT_NE(corner, painted.primitive.positions.end());
    const glm::ivec3 centre(*corner * 65536.0F);
    region.origin = centre - 20;
    region.size = glm::ivec3(40);
    expect_true(gather(painted, grid, region), painted.truth(grid), region.origin, 1.0, 1.0);
}

TEST_F(VoxelAttributesTest, WhatAMaskCutsAwayLendsNoColour) {
    // Discs of green and blue in a field of red that is cut away.
    constexpr int side = 32;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool inside = (x % 16 - 8) * (x % 16 - 8) + (y % 16 - 8) * (y % 16 - 8) < 40;
            if (inside)
                rgba.insert(rgba.end(), {0, 180, std::uint8_t(100 + 2 * x), 255});
            else
                rgba.insert(rgba.end(), {255, 0, 0, 20});
        }
    }
    Painted painted = random_triangles(6, 80, true);
    painted.use_image(side, side, rgba, scenes::AlphaMode::mask);
    std::ranges::fill(painted.primitive.colors, glm::u16vec4(65535));
    for (const int resolution : {16, 64, 200}) {
        const Result result = gather(painted, unit_cube(resolution));
        ASSERT_GT(result.attributes.colors.size(), 100U);
        for (const glm::vec3& color : result.attributes.colors) {
            ASSERT_LE(color.r, 0.001F) << "resolution " << resolution;
            ASSERT_NEAR(color.g, linear_of(180), 0.001) << "resolution " << resolution;
            ASSERT_GE(color.b, linear_of(100) - 0.001) << "resolution " << resolution;
        }
    }
}

TEST_F(VoxelAttributesTest, DarkVertexColoursKeepSixteenBits) {
    Painted painted = random_triangles(12, 60, true);
    const glm::u16vec4 dark(100, 200, 1, 65535);
    std::ranges::fill(painted.primitive.colors, dark);
    painted.scene.materials[0] = {};
    const Result result = gather(painted, unit_cube(32));
    ASSERT_GT(result.attributes.colors.size(), 100U);
    for (const glm::vec3& color : result.attributes.colors) {
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(color[c], double(dark[c]) / 65535.0, 2e-6) << "channel " << c;
    }
}

TEST_F(VoxelAttributesTest, TheOrderOfTrianglesDoesNotShow) {
    Painted painted = random_triangles(7, 400, true);
    const Result result = gather(painted, unit_cube(24));
    painted.reverse();
    const Result turned = gather(painted, unit_cube(24));
    EXPECT_EQ(result.attributes.colors, turned.attributes.colors);
    EXPECT_EQ(result.attributes.normals, turned.attributes.normals);
}

TEST_F(VoxelAttributesTest, ATileAloneEqualsItsPlaceInTheWhole) {
    const Painted painted = random_triangles(8, 200, true);
    const Grid grid = unit_cube(64);
    const Result all = gather(painted, grid);
    Region region = whole(grid);
    region.origin = {32, 5, 17};
    region.size = {31, 40, 22};
    const Result tile = gather(painted, grid, region);
    std::vector<std::size_t> numbers(64 * 64 * 64);
    const auto place = [](const glm::ivec3& v) { return std::size_t((v.z * 64 + v.y) * 64 + v.x); };
    for_each_voxel(all.bits, [&](const glm::ivec3& v, std::size_t number) { numbers[place(v)] = number; });
    for_each_voxel(tile.bits, [&](const glm::ivec3& v, std::size_t number) {
        const std::size_t same = numbers[place(v + region.origin)];
        ASSERT_EQ(tile.attributes.colors[number], all.attributes.colors[same]);
        ASSERT_EQ(tile.attributes.normals[number], all.attributes.normals[same]);
    });
    EXPECT_GT(tile.attributes.colors.size(), 500U);
}

TEST_F(VoxelAttributesTest, ASubsetGathersItsTrianglesAlone) {
    const Painted painted = random_triangles(10, 200, true);
    const Painted first = random_triangles(10, 80, true);  // the same stream, ended earlier
    const Grid grid = unit_cube(32);
    const Result alone = gather(first, grid);
    std::vector<std::uint32_t> subset(80);
    std::iota(subset.rbegin(), subset.rend(), 0U);
    const GpuSurface surface = upload(painted.surface(grid));
    const VoxelAttributes attributes =
        painter_->gather(surface, whole(grid), alone.bits, std::span<const std::uint32_t>(subset));
    EXPECT_EQ(attributes.colors, alone.attributes.colors);
    EXPECT_EQ(attributes.normals, alone.attributes.normals);
}

// Voxels like the inside of a solid: occupied, without a triangle nearby.
TEST_F(VoxelAttributesTest, VoxelsWithoutSurfaceHaveNoColour) {
    const Painted painted = random_triangles(11, 1, true);
    const GpuSurface surface = upload(painted.surface(unit_cube(32)));
    const Region region = whole(unit_cube(32));
    BitGrid bits = marker_->voxelize(surface, region);
    const glm::ivec3 inside(bits.at({0, 0, 0}) ? 31 : 0);
    ASSERT_FALSE(bits.at(inside));
    bits.set(inside);
    const VoxelAttributes attributes = painter_->gather(surface, region, bits);
    ASSERT_EQ(attributes.colors.size(), bits.count());
    const std::size_t number = inside.x == 0 ? 0 : attributes.colors.size() - 1;
    EXPECT_EQ(attributes.colors[number], glm::vec3(0.0F));
    EXPECT_EQ(attributes.normals[number], glm::vec3(0.0F));
    BitGrid none(region.size);
    EXPECT_TRUE(painter_->gather(surface, region, none).colors.empty());
}

TEST_F(VoxelAttributesTest, LinesPointsAndMereContactHaveColoursToo) {
    for (const scenes::Topology topology : {scenes::Topology::lines, scenes::Topology::points}) {
        Painted painted;
        painted.with_normals = false;
        painted.primitive.topology = topology;
        painted.add_vertex({0.1F, 0.13F, 0.2F}, {}, {0, 255, 0}, {});
        painted.add_vertex({0.9F, 0.77F, 0.8F}, {}, {0, 255, 0}, {});
        const Result result = gather(painted, unit_cube(16));
        ASSERT_GE(result.attributes.colors.size(), 2U);
        for (const glm::vec3& color : result.attributes.colors)
            EXPECT_LT(glm::length(color - glm::vec3(0.0F, 1.0F, 0.0F)), 0.002F);
        for (const glm::vec3& normal : result.attributes.normals)
            EXPECT_EQ(normal, glm::vec3(0.0F));
    }
    // A square on a plane between voxels, which it fills to their edges: those beside it are touched only.
    Painted painted;
    painted.with_normals = false;
    for (const glm::vec2 corner : {glm::vec2(0.25F), glm::vec2(0.75F, 0.25F), glm::vec2(0.75F),
                                   glm::vec2(0.25F), glm::vec2(0.75F), glm::vec2(0.25F, 0.75F)})
        painted.add_vertex({corner.x, 0.5F, corner.y}, {}, {255, 0, 255}, {});
    const Result result = gather(painted, unit_cube(8));
    EXPECT_EQ(result.attributes.colors.size(), 2U * 6 * 6);
    for (const glm::vec3& color : result.attributes.colors)
        EXPECT_LT(glm::length(color - glm::vec3(1.0F, 0.0F, 1.0F)), 0.002F);
    for (const glm::vec3& normal : result.attributes.normals)
        EXPECT_LT(glm::length(normal - glm::vec3(0.0F, -1.0F, 0.0F)), 0.001F);
}

TEST_F(VoxelAttributesTest, TheTwoSidesOfASheetCancel) {
    Painted painted = random_triangles(9, 1, false);
    for (const std::uint32_t i : {2U, 1U, 0U})
        painted.primitive.indices.push_back(i);
    const Result result = gather(painted, unit_cube(64));
    ASSERT_FALSE(result.attributes.normals.empty());
    for (const glm::vec3& normal : result.attributes.normals)
        EXPECT_EQ(normal, glm::vec3(0.0F));
}

TEST_F(VoxelAttributesTest, FarTrianglesHaveColoursInsideTheGrid) {
    Painted painted;
    painted.with_normals = false;
    painted.use_image(256, 256, smooth_image(256), scenes::AlphaMode::opaque);
    painted.add_vertex({-40.0F, 0.3F, -30.0F}, {}, {0, 255, 255}, {-9.0F, 2.0F});
    painted.add_vertex({50.0F, 0.6F, -35.0F}, {}, {255, 255, 0}, {11.0F, 3.0F});
    painted.add_vertex({3.0F, 0.45F, 60.0F}, {}, {255, 0, 255}, {1.0F, 20.0F});
    const Grid grid = unit_cube(32);
    ASSERT_EQ(painted.surface(grid).far_triangles.size(), 1U);
    expect_true(gather(painted, grid), painted.truth(grid), {}, 1.0, 1.0);
}

// More voxels than are gathered at a time, of triangles that touch more of them than pairs have room for.
TEST_F(VoxelAttributesTest, LargeTrianglesOverManyVoxelsKeepTheirColours) {
    Painted painted;
    painted.with_normals = false;
    const auto vertex = [&](float x, float z) {
        painted.add_vertex(
            {x, 0.5003F, z}, {},
            {std::uint8_t(std::lround(255.0F * x)), 128, std::uint8_t(std::lround(255.0F * z))}, {});
    };
    vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 0), vertex(1, 1), vertex(0, 1);
    constexpr int side = 1100;
    const Grid grid = unit_cube(side);
    Region region = whole(grid);
    region.origin.y = 549;
    region.size.y = 3;
    const Result result = gather(painted, grid, region);
    ASSERT_EQ(result.attributes.colors.size(), std::size_t(side) * side);
    double worst = 0.0;
    for_each_voxel(result.bits, [&](const glm::ivec3& v, std::size_t number) {
        const glm::vec3 expected((float(v.x) + 0.5F) / side, 128.0F / 255.0F, (float(v.z) + 0.5F) / side);
        worst = std::max(worst, double(glm::length(result.attributes.colors[number] - expected)));
    });
    EXPECT_LT(worst, 0.001);
}

}  // namespace
}  // namespace cairn::voxelizer
