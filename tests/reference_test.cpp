// The truth is tested against a second one that shares nothing with it: the triangle is clipped to the box in
// exact fractions, and meets it if anything is left.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "reference/exact_voxels.h"
#include "reference/image.h"
#include "reference/separating_axes.h"
#include "tests/lattice_surface.h"
#include "voxelizer/wide_integer.h"

namespace cairn::reference {
namespace {

using namespace cairn::test;
using voxelizer::Int128;

/// A point in homogeneous coordinates: (x, y, z) / w with w > 0.
struct Point {
    std::array<Int128, 4> c;
};

Int128 greatest_divisor(Int128 a, Int128 b) {
    while (b != 0) {
        const Int128 rest = a % b;
        a = b;
        b = rest;
    }
    return a < 0 ? -a : a;
}

/// The point where the segment from a to b crosses a plane, from its signed distances there.
Point crossing(const Point& a, const Point& b, Int128 at_a, Int128 at_b) {
    Point p;
    // Distances are homogeneous too: true distance = value / w.
    for (std::size_t i = 0; i < 4; ++i)
        p.c[i] = at_a * b.c[i] - at_b * a.c[i];
    Int128 divisor = p.c[3];
    for (std::size_t i = 0; i < 3; ++i)
        divisor = greatest_divisor(divisor, p.c[i]);
    if ((p.c[3] < 0) != (divisor < 0)) divisor = -divisor;
    for (Int128& c : p.c)
        c /= divisor;
    return p;
}

/// Keeps what lies on the side of a plane where sign * (coordinate - bound) >= 0.
std::vector<Point> clip(const std::vector<Point>& polygon, std::size_t axis, int sign, std::int64_t bound) {
    std::vector<Point> kept;
    const auto distance = [&](const Point& p) { return sign * (p.c[axis] - bound * p.c[3]); };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& a = polygon[i];
        const Point& b = polygon[(i + 1) % polygon.size()];
        const Int128 at_a = distance(a);
        const Int128 at_b = distance(b);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) kept.push_back(crossing(a, b, at_a, at_b));
    }
    return kept;
}

bool clipped_triangle_is_left(const LatticeTriangle& triangle, const glm::i64vec3& low,
                              const glm::i64vec3& high) {
    std::vector<Point> polygon;
    for (const glm::i64vec3& p : triangle)
        polygon.push_back({{p.x, p.y, p.z, 1}});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        polygon = clip(polygon, axis, 1, low[int(axis)]);
        polygon = clip(polygon, axis, -1, high[int(axis)]);
    }
    return !polygon.empty();
}

TEST(SeparatingAxes, AgreeWithClippingInFractions) {
    Random random(1);
    int met = 0;
    for (int i = 0; i < 100000; ++i) {
        // Small numbers meet by chance in faces, edges and corners; the second half is finer.
        const std::int64_t reach = i % 2 == 0 ? 6 : 200;
        LatticeTriangle t = {random.point(-reach, reach), random.point(-reach, reach),
                             random.point(-reach, reach)};
        if (i % 7 == 0) t[2] = t[1];
        if (i % 11 == 0) t[1] = t[0] + (t[2] - t[0]) * std::int64_t(2);
        const glm::i64vec3 low = random.point(-reach, reach);
        const glm::i64vec3 high = low + random.point(0, reach);
        const bool expected = clipped_triangle_is_left(t, low, high);
        met += expected ? 1 : 0;
        ASSERT_EQ(triangle_meets_box(t, low, high), expected)
            << to_string(t)
            << fmt::format("box ({} {} {}) to ({} {} {})", low.x, low.y, low.z, high.x, high.y, high.z);
    }
    EXPECT_GT(met, 5000) << "most boxes were missed: the trial says little";
    EXPECT_LT(met, 95000);
}

TEST(SeparatingAxes, HoldAtTheEdgeOfTheirRange) {
    const std::int64_t far = std::int64_t(1) << 40;
    // The plane x + y + z = 0 through a corner of the box, and one unit beside it.
    const LatticeTriangle t = {glm::i64vec3(far, -far, 0), glm::i64vec3(-far, 0, far),
                               glm::i64vec3(0, far, -far)};
    EXPECT_TRUE(triangle_meets_box(t, {0, 0, 0}, {5, 5, 5}));
    EXPECT_FALSE(triangle_meets_box(t, {1, 0, 0}, {5, 5, 5}));
    EXPECT_TRUE(triangle_meets_box(t, {-5, -5, -5}, {0, 0, 0}));
    EXPECT_FALSE(triangle_meets_box(t, {-5, -5, -5}, {0, -1, 0}));
}

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
