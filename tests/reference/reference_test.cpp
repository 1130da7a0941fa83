// The reference's voxels, its comparison, and its images. separating_axes_test.cpp proves the predicate.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "reference/image.h"
#include "tests/support/lattice_surface.h"

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

/// An upright square in the plane z = `z`, and a camera at z = 4 that sees it.
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
        take_snapshot();
        return ImageTracer(scene_, snapshot_).trace(camera_, light_, 8, 8, 1);
    }
    void take_snapshot() {
        snapshot_ = {};
        for (const scenes::Mesh& mesh : scene_.meshes) {
            const scenes::Primitive& primitive = mesh.primitives[0];
            snapshot_.items.push_back({&primitive, primitive.positions, {}, glm::dmat4(1.0)});
            for (const glm::vec3& p : primitive.positions)
                snapshot_.bounds.add(p);
        }
    }
    optics::Camera camera_{.eye = {0, 0, 4}, .yfov = 2.0 * std::atan(0.25)};  // one unit up and down at z = 0
    optics::Light light_{.towards = {0, 0, 1}};
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
    // A square behind the camera, so that only shadow rays meet it. Its left half is a hole.
    add_square(-1.0F, -1.0F, 1.0F, 1.0F, 6.0F, 0);
    const ReferenceImage image = trace();
    EXPECT_EQ(image.lit[1], 1);
    EXPECT_EQ(image.lit[6], 0);
}

TEST_F(Image, FindsTheSameByPacketsAsByOneRayAtATime) {
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        const auto at = [&] { return float(2.0 * random.unit() - 1.0); };
        add_square(at(), at(), at(), at(), at());
    }
    take_snapshot();
    light_.towards = {0.3, 0.4, 1.0};
    const ImageTracer tracer(scene_, snapshot_);
    for (const glm::ivec2 size : {glm::ivec2(32, 32), glm::ivec2(33, 7)}) {
        const ReferenceImage one = tracer.trace(camera_, light_, size.x, size.y);
        const ReferenceImage eight =
            tracer.trace(camera_, light_, size.x, size.y, 0, ImageTracer::Rays::packets);
        // At places where two squares meet, rounding decides which one is nearer.
        int differing = 0;
        for (std::size_t i = 0; i < one.depth.size(); ++i) {
            const bool both_empty = std::isinf(one.depth[i]) && std::isinf(eight.depth[i]);
            differing += !both_empty && std::abs(one.depth[i] - eight.depth[i]) > 1e-4F ? 1 : 0;
            differing += one.lit[i] != eight.lit[i] ? 1 : 0;
        }
        EXPECT_LE(differing, size.x * size.y / 100) << size.x << " x " << size.y;
    }
}

TEST_F(Image, ShadesByTheCosineAndCountsTheSamplesThatMeetTheScene) {
    scenes::Material& material = scene_.materials.emplace_back();
    material.base_color = {0.5F, 0.25F, 1.0F, 1.0F};
    add_square(-1.0F, -1.0F, 1.0F, 0.125F, 0.0F, 0);  // up to the middle of the fourth row
    take_snapshot();
    light_.towards = {0.0, 0.6, 0.8};
    Shading shading;
    shading.background = glm::vec3(0.0F);
    const ShadedImage image = ImageTracer(scene_, snapshot_).shade(camera_, light_, shading, 8, 8, 8);
    EXPECT_EQ(image.coverage[0], 0.0F);
    EXPECT_NEAR(image.coverage[3 * 8 + 2], 0.5F, 1e-6F);
    EXPECT_NEAR(image.coverage[5 * 8 + 2], 1.0F, 1e-6F);
    const auto srgb = [](float c) { return 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F; };
    const float light = 0.25F * 0.75F + 0.75F * 0.8F;
    for (int channel = 0; channel < 3; ++channel) {
        const float color = material.base_color[channel] * light;
        EXPECT_NEAR(image.srgb[5 * 8 + 2][channel], srgb(color), 1e-4F) << channel;
        EXPECT_NEAR(image.srgb[3 * 8 + 2][channel], srgb(0.5F * color), 1e-4F) << channel;
    }
}

}  // namespace
}  // namespace cairn::reference
