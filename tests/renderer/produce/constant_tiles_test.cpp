// Tiles with one value have no brick, and tiles to which nothing finer adds are not subdivided (Crassin et
// al. 2008, sections 4.2 and 6.1). The picture is the same as with bricks and subdivisions.
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/pool/tree.h"
#include "renderer/renderer.h"
#include "shaders/interop/pool.h"
#include "tests/support/box_content.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::TreeShape;
using renderer::View;

struct Boxed {
    Renderer renderer;
    BoxContent* content;
};

Boxed make_boxed(const Settings& settings, const BoxOptions& options) {
    auto made = std::make_unique<BoxContent>(renderer::tree_shape_of(settings.tree), options);
    BoxContent* const content = made.get();
    return {Renderer(std::move(made), settings.options()), content};
}

View view_of_box(double pixel_error) {
    View view;
    view.size.width = 72;
    view.size.height = 54;
    view.camera.eye = {1.7, 1.1, 2.1};
    view.camera.target = {0.5, 0.4, 0.5};
    view.detail.pixel_error = pixel_error;
    view.light.towards = {0.3, 1.0, 0.2};
    return view;
}

struct Shape {
    int n, m, max_resolution, margin;
};

class ConstantTiles : public GlTest, public ::testing::WithParamInterface<Shape> {
protected:
    [[nodiscard]] static Settings tree() {
        return {.tree = {.n = GetParam().n, .m = GetParam().m, .max_resolution = GetParam().max_resolution}};
    }
    [[nodiscard]] static BoxOptions box(bool constant) {
        return {.n = GetParam().n, .margin = GetParam().margin, .constant = constant};
    }
};

glm::dvec3 direction_of(const View& view, int x, int y) {
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half = std::tan(0.5 * view.camera.yfov);
    const double px = ((x + 0.5) / view.size.width * 2.0 - 1.0) * half * view.size.width / view.size.height;
    const double py = ((y + 0.5) / view.size.height * 2.0 - 1.0) * half;
    return glm::normalize(forward + px * right - py * up);
}

/// The length of a ray in the cube [low, high]^3 of the world; negative if it passes beside the cube.
double length_in_cube(const View& view, const glm::dvec3& direction, double low, double high) {
    const glm::dvec3 a = (low - view.camera.eye) / direction;
    const glm::dvec3 b = (high - view.camera.eye) / direction;
    const glm::dvec3 near = glm::min(a, b);
    const glm::dvec3 far = glm::max(a, b);
    return std::min({far.x, far.y, far.z}) - std::max({near.x, near.y, near.z});
}

int srgb(double linear) {
    const double c = std::min(linear, 1.0);
    return int(std::lround(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055)));
}

TEST_P(ConstantTiles, HoldNoBrickAndCoverAsTheirBricksWould) {
    View view = view_of_box(1e-6);
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    Boxed with = make_boxed(tree(), box(true));
    Boxed without = make_boxed(tree(), box(false));
    const renderer::Frame ours = with.renderer.render(view);
    const renderer::Frame bricks = without.renderer.render(view);
    EXPECT_GT(ours.statistics.constant_tiles, 0U);
    EXPECT_EQ(bricks.statistics.constant_tiles, 0U);
    EXPECT_EQ(ours.statistics.bricks_resident + ours.statistics.constant_tiles,
              bricks.statistics.bricks_resident);
    std::size_t half_covered = 0;
    for (std::size_t i = 3; i < ours.image.rgba.size(); i += 4) {
        ASSERT_LE(std::abs(int(ours.image.rgba[i]) - int(bricks.image.rgba[i])), 1)
            << "coverage of pixel (" << i / 4 % 72 << ", " << i / 4 / 72 << ")";
        half_covered += ours.image.rgba[i] > 20 && ours.image.rgba[i] < 235 ? 1 : 0;
    }
    EXPECT_GT(half_covered, 20U) << "nothing shines through: coverage proves little";
    const renderer::Frame frame = with.renderer.render(view);
    EXPECT_EQ(frame.statistics.bricks_produced, 0U) << "a constant tile was asked for again";
}

TEST_P(ConstantTiles, HaveTheColourOfTheirMean) {
    View view = view_of_box(1e-6);
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    view.light.ambient = 1.0F;
    const optics::Image ours = make_boxed(tree(), box(true)).renderer.render(view).image;
    const double margin = double(GetParam().margin) / GetParam().n;
    const double voxel =
        1.0 /
        renderer::make_tree_shape_within(GetParam().n, GetParam().m, GetParam().max_resolution).resolution();
    int judged = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const glm::dvec3 direction = direction_of(view, x, y);
            // 64 voxels of 2 * 2 / 255 are opaque together: the floor is not visible.
            if (length_in_cube(view, direction, margin, 1.0 - margin) < 66.0 * voxel) continue;
            const std::size_t pixel = std::size_t(y * view.size.width + x) * 4;
            // Without normals the fog faces the viewer; bricks around the constant tiles hold rounded ones,
            // which do not.
            const double least = 0.75 + 0.25 * std::min(-direction.y, 0.5) - 0.26;
            const double most = 1.0;
            for (int k = 0; k < 3; ++k) {
                const double root = double(BoxContent::fog[k]) / BoxContent::fog.a;
                ASSERT_GE(int(ours.rgba[pixel + std::size_t(k)]), srgb(root * root * least) - 1)
                    << x << ' ' << y;
                ASSERT_LE(int(ours.rgba[pixel + std::size_t(k)]), srgb(root * root * most) + 1)
                    << x << ' ' << y;
            }
            ASSERT_EQ(ours.rgba[pixel + 3], 255) << x << ' ' << y;
            ++judged;
        }
    }
    EXPECT_GT(judged, 50);
}

TEST_P(ConstantTiles, CastTheShadowsThatTheirBricksWould) {
    const View view = view_of_box(1e-6);
    const optics::Image ours = make_boxed(tree(), box(true)).renderer.render(view).image;
    const optics::Image bricks = make_boxed(tree(), box(false)).renderer.render(view).image;
    View unlit = view;
    unlit.shadow.kind = renderer::ShadowQuality::Kind::none;
    const optics::Image without_shadow = make_boxed(tree(), box(true)).renderer.render(unlit).image;
    const double margin = double(GetParam().margin) / GetParam().n;
    int in_shadow = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const std::size_t pixel = std::size_t(y * view.size.width + x) * 4;
            if (length_in_cube(view, direction_of(view, x, y), margin - 0.01, 1.01 - margin) > 0.0) continue;
            ASSERT_LE(std::abs(int(ours.rgba[pixel]) - int(bricks.rgba[pixel])), 1)
                << "floor at pixel (" << x << ", " << y << ")";
            in_shadow += ours.rgba[pixel] + 10 < without_shadow.rgba[pixel] ? 1 : 0;
        }
    }
    EXPECT_GT(in_shadow, 20);
}

TEST_P(ConstantTiles, PictureDoesNotDependOnPoolsNorOnTheFramesBefore) {
    const View view = view_of_box(1e-6);
    const optics::Image expected = make_boxed(tree(), box(true)).renderer.render(view).image;
    Settings tight = tree();
    const std::size_t side = std::size_t(tight.tree.m) + 2;
    tight.pools.brick_bytes = 2 * side * side * side * 9;
    tight.pools.node_bytes = std::size_t(tight.tree.n * tight.tree.n * tight.tree.n) * 20 * 5;
    Boxed small = make_boxed(tight, box(true));
    View little = view;
    little.size.width = 24;
    little.size.height = 18;
    const renderer::Frame small_picture = small.renderer.render(little);
    EXPECT_EQ(small_picture.image.rgba, make_boxed(tree(), box(true)).renderer.render(little).image.rgba);
    EXPECT_LE(small_picture.statistics.node_pool_bytes, tight.pools.node_bytes);

    Boxed used = make_boxed(tree(), box(true));
    (void)used.renderer.render(view_of_box(16.0));
    EXPECT_EQ(used.renderer.render(view).image.rgba, expected.rgba);
    Boxed hasty = make_boxed(tree(), box(true));
    for (int frame = 0; frame < 2000; ++frame) {
        const renderer::Frame image = hasty.renderer.render(view, {.budget = Milliseconds(20.0)});
        if (!image.statistics.converged) continue;
        EXPECT_EQ(image.image.rgba, expected.rgba);
        return;
    }
    FAIL() << "2000 frames did not end with a whole picture";
}

TEST_P(ConstantTiles, TilesOfLowFrequencyAreShownAsTheyAreAtEveryDistance) {
    BoxOptions options = box(true);
    options.low_frequency = true;
    const View view = view_of_box(1e-6);
    Boxed fresh = make_boxed(tree(), options);
    const optics::Image expected = fresh.renderer.render(view).image;
    const TreeShape shape =
        renderer::make_tree_shape_within(GetParam().n, GetParam().m, GetParam().max_resolution);
    int deepest_low = 0;
    int deepest_high = 0;
    for (const renderer::Tile& tile : fresh.content->produced()) {
        // Tiles of level 1 alone are final.
        const std::int64_t above =
            tile.position.x / std::max(shape.tiles_across(std::max(tile.level - 1, 0)), 1);
        int& deepest = tile.level >= 1 && above < shape.n / 2 ? deepest_low : deepest_high;
        deepest = std::max(deepest, tile.level);
    }
    EXPECT_EQ(deepest_low, 1);
    EXPECT_EQ(deepest_high, shape.max_level);

    Boxed used = make_boxed(tree(), options);
    (void)used.renderer.render(view_of_box(64.0));
    EXPECT_EQ(used.renderer.render(view).image.rgba, expected.rgba) << "what was looked at before shows";
    Settings tight = tree();
    const std::size_t side = std::size_t(tight.tree.m) + 2;
    tight.pools.brick_bytes = 2 * side * side * side * 9;
    View little = view;
    little.size.width = 24;
    little.size.height = 18;
    EXPECT_EQ(make_boxed(tight, options).renderer.render(little).image.rgba,
              make_boxed(tree(), options).renderer.render(little).image.rgba);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConstantTiles,
                         ::testing::Values(Shape{4, 8, 128, 1}, Shape{3, 27, 243, 1}, Shape{8, 8, 512, 2}),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}", shape.param.n, shape.param.m);
                         });

class TreeFlags : public GlTest {};

TEST_F(TreeFlags, ConstantTileGivesItsSlotBackAndIsNeverAskedForAgain) {
    const TreeShape shape = renderer::make_tree_shape(2, 8, 64);
    renderer::Tree tree(shape, 2, 1U << 16U, glm::uvec2(0xFF, 0), true);
    tree.begin_round(renderer::Round{1}, {0, 0});
    const std::uint32_t first = tree.add_children(0).value();
    tree.begin_round(renderer::Round{2}, {0, 0});
    ASSERT_TRUE(tree.add_brick(first));
    ASSERT_TRUE(tree.add_brick(first + 1));
    EXPECT_FALSE(tree.add_brick(first + 2)) << "a third slot of two";
    tree.set_constant(first, {1, 2, 3, 4});
    EXPECT_FALSE(tree.slot(first));
    EXPECT_EQ(tree.bricks_resident(), 1);
    EXPECT_TRUE(tree.add_brick(first + 2));
    tree.begin_round(renderer::Round{3}, {0, 0});
    EXPECT_FALSE(tree.wants_brick(first));
    EXPECT_TRUE(tree.wants_children(first)) << "one value at its own level says nothing of finer ones";
    EXPECT_EQ(tree.node(first).brick, NODE_CONSTANT);
    tree.set_constant(first + 3, glm::u8vec4(0));
    EXPECT_EQ(tree.node(first + 3).brick, NODE_CONSTANT | NODE_EMPTY);
}

TEST_F(TreeFlags, WhatIsKnownOfATileOutlivesItsBrick) {
    const TreeShape shape = renderer::make_tree_shape(2, 8, 64);
    renderer::Tree tree(shape, 1, 1U << 16U, glm::uvec2(0xFF, 0));
    tree.begin_round(renderer::Round{1}, {0});
    const std::uint32_t first = tree.add_children(0).value();
    tree.begin_round(renderer::Round{2}, {0});
    ASSERT_TRUE(tree.add_brick(first));
    tree.set_produced(first);
    tree.set_final(first);
    EXPECT_FALSE(tree.wants_children(first));
    tree.begin_round(renderer::Round{3}, {0});
    ASSERT_TRUE(tree.add_brick(first + 1)) << "the only slot changes hands";
    EXPECT_FALSE(tree.slot(first));
    EXPECT_TRUE(tree.was_produced(first));
    EXPECT_TRUE(tree.wants_brick(first));
    EXPECT_FALSE(tree.wants_children(first));
}

}  // namespace
}  // namespace cairn::test
