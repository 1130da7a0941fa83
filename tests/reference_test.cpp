// The truth's voxels, its comparison, and its images; separating_axes_test.cpp proves the predicate.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "reference/image.h"
#include "tests/lattice_surface.h"

namespace cairn::reference {
namespace {

using namespace cairn::test;

TEST(ExactVoxels, FindEveryVoxelThatTheTriangleMeets) {
    Random random(2);
    const voxelizer::Region region{4, {-2, -1, 0}, {20, 19, 17}};
    for (int i = 0; i < 60; ++i) {
        const LatticeTriangle t = random_triangle(random, region.voxel_side());
        const voxelizer::Surface surface = lattice_surface({t}, 16);
        EXPECT_TRUE(same_bits(exact_voxels(surface, region), voxels_of(t, region))) << to_string(t);
    }
}

TEST(ExactVoxels, FindTrianglesOfAnySizeSideBySide) {
    Random random(3);
    std::vector<LatticeTriangle> triangles;
    const voxelizer::Region region{5, glm::ivec3(0), glm::ivec3(32)};
    voxelizer::BitGrid expected(region.size);
    for (int i = 0; i < 40; ++i) {
        triangles.push_back(random_triangle(random, region.voxel_side()));
        const voxelizer::BitGrid one = voxels_of(triangles.back(), region);
        for (std::size_t w = 0; w < one.words.size(); ++w)
            expected.words[w] |= one.words[w];
    }
    EXPECT_TRUE(same_bits(exact_voxels(lattice_surface(triangles, 32), region), expected));
}

TEST(Comparison, CountsMissingAndExtra) {
    voxelizer::BitGrid truth(glm::ivec3(40, 3, 2));
    voxelizer::BitGrid ours(truth.size);
    truth.set({0, 0, 0});
    truth.set({39, 2, 1});
    ours.set({0, 0, 0});
    ours.set({33, 1, 1});
    const Comparison comparison = compare(ours, truth);
    EXPECT_EQ(comparison.occupied, 2U);
    EXPECT_EQ(comparison.missing, 1U);
    EXPECT_EQ(comparison.extra, 1U);
    ASSERT_EQ(comparison.first_different.size(), 2U);
    EXPECT_EQ(comparison.first_different[0], glm::ivec3(33, 1, 1));
    EXPECT_EQ(comparison.first_different[1], glm::ivec3(39, 2, 1));
}

/// One square, upright, in the plane z = `z`, and a camera at z = 4 that sees it.
class Image : public ::testing::Test {
protected:
    void add_square(float low_x, float low_y, float high_x, float high_y, float z, int material = -1) {
        scenes::Primitive& primitive = scene_.meshes.emplace_back().primitives.emplace_back();
        primitive.positions = {
            {low_x, low_y, z}, {high_x, low_y, z}, {high_x, high_y, z}, {low_x, high_y, z}};
        primitive.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
        primitive.indices = {0, 1, 2, 0, 2, 3};
        primitive.material = material;
    }
    ReferenceImage trace() {
        snapshot_ = {};
        for (const scenes::Mesh& mesh : scene_.meshes) {
            const scenes::Primitive& primitive = mesh.primitives[0];
            snapshot_.items.push_back({&primitive, primitive.positions, {}, glm::dmat4(1.0)});
            for (const glm::vec3& p : primitive.positions)
                snapshot_.bounds.add(p);
        }
        ReferenceCamera camera;
        camera.eye = {0, 0, 4};
        camera.yfov = 2.0 * std::atan(0.25);  // one unit up and down at z = 0
        ReferenceLight light;
        light.towards = {0, 0, 1};
        return ImageTracer(scene_, snapshot_).trace(camera, light, 8, 8, 1);
    }
    scenes::Scene scene_;
    scenes::Snapshot snapshot_;
};

TEST_F(Image, PutsXToTheRightAndYUp) {
    add_square(0.0F, 0.0F, 1.0F, 1.0F, 0.0F);
    const ReferenceImage image = trace();
    EXPECT_EQ(image.primitive[0], ReferenceImage::no_primitive) << "top left";
    EXPECT_NE(image.primitive[7], ReferenceImage::no_primitive) << "top right";
    EXPECT_EQ(image.primitive[56], ReferenceImage::no_primitive) << "bottom left";
    EXPECT_EQ(image.primitive[63], ReferenceImage::no_primitive) << "bottom right";
    const glm::dvec2 pixel(7.0 / 8.0, 7.0 / 8.0);  // its centre in the plane z = 0
    EXPECT_NEAR(image.depth[7], std::sqrt(16.0 + pixel.x * pixel.x + pixel.y * pixel.y), 1e-5);
    EXPECT_TRUE(std::isinf(image.depth[0]));
    EXPECT_EQ(image.lit[7], 1);
}

TEST_F(Image, LetsShadowsFallThroughHoles) {
    scene_.images.push_back({"half", 2, 1, {255, 255, 255, 0, 255, 255, 255, 255}});
    scene_.textures.push_back({0, scenes::Wrap::repeat, scenes::Wrap::repeat});
    scenes::Material& material = scene_.materials.emplace_back();
    material.texture = 0;
    material.alpha_mode = scenes::AlphaMode::mask;
    add_square(-1.0F, -1.0F, 1.0F, 1.0F, 0.0F);
    // Behind the camera, so that only shadow rays meet it; its left half is a hole.
    add_square(-1.0F, -1.0F, 1.0F, 1.0F, 6.0F, 0);
    const ReferenceImage image = trace();
    EXPECT_EQ(image.lit[1], 1);
    EXPECT_EQ(image.lit[6], 0);
}

}  // namespace
}  // namespace cairn::reference
