// Grids, scenes on the lattice, bit grids and their file, all without OpenGL.
#include "voxelizer/surface/surface.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/masked_scene.h"
#include "tests/support/scratch_folder.h"
#include "voxelizer/files/write_npy.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::voxelizer {
namespace {

using namespace cairn::test;

scenes::Bounds bounds_of(const glm::dvec3& low, const glm::dvec3& high) {
    scenes::Bounds bounds;
    bounds.add(low);
    bounds.add(high);
    return bounds;
}

TEST(Grid, LeavesOneEmptyVoxelOnEachSideOfTheLongestAxis) {
    for (const int resolution : {3, 4, 33, 64, 100, 512}) {
        const Grid grid = grid_around(bounds_of({-3, 1, 10}, {5, 4, 11}), resolution);
        const std::int64_t side = std::int64_t(1) << (LATTICE_BITS - grid.level());
        const glm::i64vec3 low = grid.lattice_from_world({-3, 1, 10});
        const glm::i64vec3 high = grid.lattice_from_world({5, 4, 11});
        EXPECT_GT(low.x, side) << resolution << ": the first voxel is touched";
        EXPECT_LT(high.x, side * (resolution - 1)) << resolution << ": the last voxel is touched";
        EXPECT_LT(low.x, 2 * side) << resolution;
        EXPECT_NEAR(double(low.y + high.y), double(side * resolution), 2.0) << "not centred";
    }
}

TEST(Grid, SmallResolutionsLeaveNone) {
    for (const int resolution : {1, 2}) {
        const Grid grid = grid_around(bounds_of(glm::dvec3(0), {4, 2, 1}), resolution);
        EXPECT_EQ(grid.voxel_size * resolution, 4.0);
        EXPECT_EQ(grid.lattice_from_world({0, 0, 0}).x, 0);
        EXPECT_EQ(grid.lattice_from_world({4, 0, 0}).x, lattice_side);
    }
}

TEST(Grid, EmptyBoundsAndPointsGiveACubeOfOne) {
    const Grid empty = grid_around({}, 10);
    EXPECT_DOUBLE_EQ(empty.voxel_size, 0.1);
    const Grid point = grid_around(bounds_of({7, 8, 9}, {7, 8, 9}), 10);
    EXPECT_DOUBLE_EQ(point.voxel_size, 0.1);
    EXPECT_DOUBLE_EQ(point.origin.x, 6.5);
}

TEST(Grid, BoundsAreKept) {
    const Grid grid = grid_over(bounds_of({1, 2, 3}, {2, 6, 4}), 8);
    EXPECT_EQ(grid.origin, glm::dvec3(1, 2, 3));
    EXPECT_EQ(grid.voxel_size, 0.5);
    EXPECT_THROW((void)grid_over(bounds_of({1, 2, 3}, {1, 2, 3}), 8), Error);
    EXPECT_THROW((void)grid_over({}, 8), Error);
}

TEST(Grid, ResolutionsOutOfRangeAreRefused) {
    for (const int resolution : {0, -1, (1 << 24) + 1}) {
        EXPECT_THROW((void)grid_around({}, resolution), Error) << resolution;
    }
}

TEST(Grid, PointsThatAreNotFiniteOrTooFarAreRefused) {
    const Grid grid = unit_grid(16);
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e9}) {
        try {
            (void)grid.lattice_from_world({0, bad, 0});
            ADD_FAILURE() << bad << " was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), std::isfinite(bad) ? Fault::usage : Fault::input);
        }
    }
}

/// A scene of one primitive at some places.
struct OneMesh {
    scenes::Scene scene;
    scenes::Primitive primitive;
    [[nodiscard]] Surface surface(const Grid& grid, const std::vector<glm::dmat4>& places = {glm::dmat4(1.0)},
                                  bool attributes = false) const {
        scenes::Snapshot snapshot;
        for (const glm::dmat4& place : places) {
            snapshot.items.push_back({&primitive, primitive.positions, primitive.normals, place});
        }
        return build_surface(scene, snapshot, grid, {attributes});
    }
};

TEST(BuildSurface, RoundsEachVertexOnceToTheNearestLatticePoint) {
    OneMesh mesh;
    mesh.primitive.positions = {{0.25F, 0.5F, 1.0F}, {0.3F, 15.9F, 7.7F}, {3, 4, 5}};
    mesh.primitive.indices = {0, 1, 2};
    const Surface surface = mesh.surface(unit_grid(16));
    ASSERT_EQ(surface.chunks.size(), 1U);
    const double units = 0x1p20;  // a voxel of 16 across 2^24
    for (std::size_t i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(surface.chunks[0].positions[i][std::size_t(axis)],
                      std::int64_t(std::floor(double(mesh.primitive.positions[i][axis]) * units + 0.5)));
        }
    }
}

TEST(BuildSurface, SharedCornersStayTogetherUnderAnyTransform) {
    // One vertex as the corner of two meshes under the same negative, uneven scale.
    OneMesh mesh;
    mesh.primitive.positions = {
        {1.1F, 2.3F, 3.7F}, {1.9F, 2.1F, 3.2F}, {1.4F, 2.8F, 3.3F}, {1.1F, 2.3F, 3.7F}};
    mesh.primitive.indices = {0, 1, 2, 3, 2, 1};
    glm::dmat4 place(1.0);
    place[0][0] = -3.3;
    place[1][1] = 1.7;
    place[3] = {9.1, 0.3, 1.2, 1.0};
    const Surface surface = mesh.surface(unit_grid(16), {place});
    EXPECT_EQ(surface.chunks[0].positions[0], surface.chunks[0].positions[3]);
}

TEST(BuildSurface, LinesAndPointsAreDegenerateTriangles) {
    OneMesh mesh;
    mesh.primitive.positions = {{1, 1, 1}, {2, 3, 4}, {5, 5, 5}};
    mesh.primitive.indices = {0, 1, 1, 2};
    mesh.primitive.topology = scenes::Topology::lines;
    Surface surface = mesh.surface(unit_grid(16));
    ASSERT_EQ(surface.triangle_count, 2U);
    EXPECT_EQ(surface.chunks[0].triangles[0].vertices, glm::uvec3(0, 1, 1));
    mesh.primitive.topology = scenes::Topology::points;
    surface = mesh.surface(unit_grid(16));
    ASSERT_EQ(surface.triangle_count, 4U);
    EXPECT_EQ(surface.chunks[0].triangles[3].vertices, glm::uvec3(2, 2, 2));
}

TEST(BuildSurface, LeavesOutWhatMissesTheCubeAndSetsFarTrianglesApart) {
    OneMesh mesh;
    mesh.primitive.positions = {{-1, -1, -1}, {-2, 3, 4}, {-0.5F, 5, 5},  // outside
                                {16, 0, 0},   {17, 1, 0}, {17, 0, 1},     // touches the cube's face
                                {0, 0, 0},    {90, 1, 0}, {17, 0, 1}};    // reaches far
    mesh.primitive.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const Surface surface = mesh.surface(unit_grid(16));
    EXPECT_EQ(surface.triangle_count, 2U);
    EXPECT_EQ(surface.chunks[0].triangles.size(), 1U);
    EXPECT_EQ(surface.chunks[0].positions.size(), 3U) << "vertices that no triangle uses";
    EXPECT_EQ(surface.far_triangles.size(), 1U);
}

TEST(BuildSurface, VerticesThatNothingUsesMayLieAnywhere) {
    OneMesh mesh;
    mesh.primitive.positions = {{1e38F, 0, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {0, -1e30F, 0}};
    mesh.primitive.indices = {1, 2, 3};
    const Surface surface = mesh.surface(unit_grid(16));
    EXPECT_EQ(surface.triangle_count, 1U);
    EXPECT_EQ(surface.chunks[0].positions.size(), 3U);
    mesh.primitive.indices = {1, 2, 4};
    EXPECT_THROW((void)mesh.surface(unit_grid(16)), Error);
}

TEST(BuildSurface, FarFromTheOriginNothingIsLost) {
    for (const double offset : {1e6, 1e8}) {
        OneMesh mesh;
        mesh.primitive.positions = {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}};
        mesh.primitive.indices = {0, 1, 2};
        glm::dmat4 place(1.0);
        place[3] = {offset, -offset, offset, 1.0};
        Grid grid = unit_grid(16);
        grid.origin = {offset, -offset, offset};
        const Surface here = mesh.surface(unit_grid(16));
        const Surface there = mesh.surface(grid, {place});
        EXPECT_EQ(here.chunks[0].positions, there.chunks[0].positions) << offset;
    }
}

TEST(BuildSurface, DenormalSizesAreVoxelizedLikeAnyOther) {
    OneMesh mesh;
    mesh.primitive.positions = {{0, 0, 0}, {1e-40F, 0, 0}, {0, 1e-40F, 0}};
    mesh.primitive.indices = {0, 1, 2};
    const Surface surface = mesh.surface(grid_around(bounds_of(glm::dvec3(0), {1e-40, 1e-40, 0}), 32));
    const BitGrid bits = reference::exact_voxels(surface, whole(surface.grid));
    // Half a square of 30 voxels, in the plane between two layers.
    EXPECT_GT(bits.count(), 880U);
    EXPECT_LT(bits.count(), 980U);
}

TEST(BuildSurface, PositionsThatAreNotFiniteAreRefused) {
    OneMesh mesh;
    mesh.primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}};
    mesh.primitive.indices = {0, 1, 2};
    EXPECT_THROW((void)mesh.surface(unit_grid(16)), Error);
}

TEST(BuildSurface, CarriesAttributesWhenAsked) {
    OneMesh mesh;
    mesh.primitive.positions = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}};
    mesh.primitive.normals = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}};
    mesh.primitive.texcoords = {{0.5F, 0.25F}, {1, 1}, {0, 0}};
    mesh.primitive.colors = {{10, 20000, 300, 40000}, {65535, 65535, 65535, 65535}, {0, 0, 0, 65535}};
    mesh.primitive.indices = {0, 1, 2};
    EXPECT_TRUE(mesh.surface(unit_grid(16)).chunks[0].attributes.empty());
    const Surface surface = mesh.surface(unit_grid(16), {glm::dmat4(1.0)}, true);
    ASSERT_EQ(surface.chunks[0].attributes.size(), 3U);
    EXPECT_TRUE(surface.has_color);
    EXPECT_EQ(surface.chunks[0].attributes[0].red_green, 10U | 20000U << 16);
    EXPECT_EQ(surface.chunks[0].attributes[0].blue_alpha, 300U | 40000U << 16);
    EXPECT_EQ(alpha_of(surface.chunks[0].attributes[0]), 40000);
    EXPECT_EQ(texcoord_of(surface.chunks[0].attributes[0]), glm::vec2(0.5F, 0.25F));
    for (const interop::SurfaceAttributes& attributes : surface.chunks[0].attributes)
        EXPECT_NE(attributes.normal, 0U);
}

TEST(BuildSurface, MaterialsThatHideEverythingLeaveNothing) {
    OneMesh mesh;
    scenes::Material& material = mesh.scene.materials.emplace_back();
    material.alpha_mode = scenes::AlphaMode::mask;
    material.base_color.a = 0.4F;
    mesh.primitive.material = 0;
    mesh.primitive.positions = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}};
    mesh.primitive.indices = {0, 1, 2};
    EXPECT_EQ(mesh.surface(unit_grid(16)).triangle_count, 0U);
    mesh.scene.materials[0].alpha_mode = scenes::AlphaMode::blend;
    EXPECT_EQ(mesh.surface(unit_grid(16)).triangle_count, 1U) << "blended surfaces count";
}

TEST(BuildSurface, MaterialsThatShareAPictureShareTheCountsOfTheirMasks) {
    constexpr std::size_t picture = 64;
    constexpr std::size_t counts = 81;
    const auto texels_with = [](const std::vector<float>& cutoffs, std::uint64_t most_bytes) {
        MaskedScene masked(8, 8, std::vector<std::uint8_t>(picture, 128), scenes::Wrap::repeat,
                           scenes::Wrap::repeat);
        masked.add({glm::vec3(0.1F), glm::vec3(0.9F, 0.1F, 0.1F), glm::vec3(0.1F, 0.9F, 0.1F)}, {});
        std::vector<scenes::Primitive> primitives(cutoffs.size(), masked.primitive);
        scenes::Snapshot snapshot;
        for (std::size_t i = 0; i < cutoffs.size(); ++i) {
            if (i > 0) {
                scenes::Material& material = masked.scene.materials.emplace_back();
                material.texture = 0;
                material.alpha_mode = scenes::AlphaMode::mask;
            }
            masked.scene.materials[i].alpha_cutoff = cutoffs[i];
            primitives[i].material = int(i);
            snapshot.items.push_back({&primitives[i], primitives[i].positions, {}, glm::dmat4(1.0)});
        }
        masked.scene.placing.bytes = most_bytes;
        return build_surface(masked.scene, snapshot, {glm::dvec3(0.0), 1.0 / 8, glm::ivec3(8)}).texels.size();
    };
    EXPECT_EQ(texels_with({0.5F}, 1U << 20U), picture + counts);
    // 0.5 and 0.5004 lie between the same two of 256 steps, 0.7 lies elsewhere.
    EXPECT_EQ(texels_with({0.5F, 0.5F, 0.5004F}, 1U << 20U), picture + counts);
    EXPECT_EQ(texels_with({0.5F, 0.7F, 0.5F, 0.7F}, 1U << 20U), picture + 2 * counts);
    EXPECT_EQ(texels_with({0.5F, 0.7F}, 4 * (picture + 2 * counts)), picture + 2 * counts);
    EXPECT_THROW((void)texels_with({0.5F, 0.7F}, 4 * (picture + 2 * counts) - 1), Error);
}

TEST(BitGrid, KeepsTheBitsPastARowAtZero) {
    BitGrid bits(glm::ivec3(33, 2, 2));
    bits.set({32, 1, 1});
    EXPECT_EQ(bits.words_per_row(), 2);
    EXPECT_EQ(bits.words[7], 1U);
    EXPECT_TRUE(bits.at({32, 1, 1}));
    EXPECT_EQ(bits.count(), 1U);
}

TEST(BitmaskPyramid, OfOddSizesRoundsUp) {
    BitGrid bits(glm::ivec3(67, 3, 1));
    bits.set({66, 2, 0});
    const BitmaskPyramid pyramid = build_pyramid(bits);
    EXPECT_EQ(pyramid.level(1).size, glm::ivec3(34, 2, 1));
    EXPECT_TRUE(pyramid.level(1).at({33, 1, 0}));
    EXPECT_EQ(pyramid.level(1).count(), 1U);
    EXPECT_EQ(pyramid.level(pyramid.level_count() - 1).size, glm::ivec3(1));
    EXPECT_EQ(pyramid.level(pyramid.level_count() - 1).count(), 1U);
}

TEST(WriteNpy, HoldsXThenYThenZ) {
    const ScratchFolder folder;
    BitGrid bits(glm::ivec3(35, 2, 3));
    bits.set({34, 1, 0});
    bits.set({0, 0, 2});
    write_npy(bits, folder.file("a.npy"));
    const std::string text = read_text(folder.file("a.npy"));
    ASSERT_GE(text.size(), 128U);
    EXPECT_EQ(text.substr(1, 5), "NUMPY");
    EXPECT_NE(text.find("'shape': (35, 2, 3), "), std::string::npos);
    const std::size_t header = 10 + std::size_t(static_cast<unsigned char>(text[8])) +
                               256 * std::size_t(static_cast<unsigned char>(text[9]));
    EXPECT_EQ(header % 64, 0U);
    EXPECT_EQ(text[header - 1], '\n');
    ASSERT_EQ(text.size(), header + 35 * 2 * 3);
    for (std::size_t i = 0; i < 35 * 2 * 3; ++i) {
        const bool expected = i == (34 * 2 + 1) * 3 + 0 || i == 2;
        EXPECT_EQ(text[header + i], expected ? 1 : 0) << i;
    }
}

}  // namespace
}  // namespace cairn::voxelizer
