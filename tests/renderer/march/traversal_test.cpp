// Traversals, late starts and early ends of rays make them faster, and change no bit of the picture.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::LevelOfDetail;
using renderer::Renderer;
using renderer::Traversal;
using renderer::View;

Renderer make_renderer(const scenes::Scene& scene, const Settings& options) {
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

/// The number of pixels that differ, and the first one.
std::string difference(const optics::Image& a, const optics::Image& b) {
    std::size_t count = 0;
    std::string first;
    for (std::size_t pixel = 0; pixel * 4 < a.rgba.size(); ++pixel) {
        const auto* pa = &a.rgba[pixel * 4];
        const auto* pb = &b.rgba[pixel * 4];
        if (std::equal(pa, pa + 4, pb)) continue;
        if (count++ == 0) {
            first = fmt::format("first ({}, {}): {} {} {} {} against {} {} {} {}",
                                pixel % std::size_t(a.width), pixel / std::size_t(a.width), pa[0], pa[1],
                                pa[2], pa[3], pb[0], pb[1], pb[2], pb[3]);
        }
    }
    return count == 0 ? "" : fmt::format("{} pixels differ, {}", count, first);
}

/// Needles and wires, thinner than a voxel, in all directions, some of them along the axes.
scenes::Scene needles() {
    std::mt19937 rng(11);
    auto unit = [&] { return float(rng() >> 8) * 0x1p-24F; };
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 from(unit(), unit(), unit());
        glm::vec3 to(unit(), unit(), unit());
        if (i % 4 == 0) to = from + glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (unit() - 0.5F);
        const glm::vec3 aside = 1e-3F * (glm::vec3(unit(), unit(), unit()) - 0.5F);
        corners.insert(corners.end(), {from, to, from + aside});
    }
    return triangles(corners);
}

/// Views that are difficult for starts and ends of rays: from inside, along axes through voxel planes, from
/// very far, through a narrow or a wide lens.
std::vector<View> hard_views(const scenes::Scene& scene) {
    const scenes::Bounds bounds = scenes::take_snapshot(scene).bounds;
    const glm::dvec3 middle = 0.5 * (glm::dvec3(bounds.low) + glm::dvec3(bounds.high));
    const double size = glm::length(glm::dvec3(bounds.high) - glm::dvec3(bounds.low));
    View view;
    view.size.width = 101;
    view.size.height = 67;
    view.detail.pixel_error = 0.7;
    view.camera = optics::framing_camera(bounds, double(view.size.width) / view.size.height);
    std::vector<View> views{view};
    auto add = [&](const glm::dvec3& eye, const glm::dvec3& target, double yfov) {
        View other = view;
        other.camera.eye = eye;
        other.camera.target = target;
        other.camera.yfov = yfov;
        views.push_back(other);
    };
    add(middle, middle + glm::dvec3(1.0, 0.0, 0.0), 1.0);
    add(middle + glm::dvec3(0.0, 0.0, size), middle, 0.6);
    add(middle - glm::dvec3(2.0 * size, 0.0, 0.0), middle, 0.3);
    add(middle + glm::dvec3(300.0, 200.0, 500.0) * size, middle, 0.002);
    add(middle + glm::dvec3(0.1, 0.2, 0.05) * size, middle, 2.6);
    std::mt19937 rng(5);
    auto unit = [&] { return double(rng() >> 8) * 0x1p-24; };
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 eye = middle + (glm::dvec3(unit(), unit(), unit()) - 0.5) * 1.2 * size;
        add(eye, middle + (glm::dvec3(unit(), unit(), unit()) - 0.5) * 0.5 * size, 0.2 + unit());
    }
    views.back().light.positional = true;
    views.back().light.position = middle + glm::dvec3(0.2, 0.9, 0.1) * size;
    views.front().light.towards = {0.0, 1.0, 0.0};
    views[1].shadow.pixel_error = 4.0;
    views[2].shadow.pixel_error = 16.0;
    return views;
}

struct Shape {
    int n, m;
    LevelOfDetail::Kind level_of_detail;
};

class Shapes : public GlTest, public ::testing::WithParamInterface<Shape> {
protected:
    static Settings options() {
        return {.tree = {.n = GetParam().n,
                         .m = GetParam().m,
                         .max_resolution = 1024,
                         .mips = GetParam().level_of_detail == LevelOfDetail::Kind::blended},
                .pools = {.brick_bytes = 48U << 20U}};
    }
    static std::vector<View> views(const scenes::Scene& scene) {
        std::vector<View> views = hard_views(scene);
        for (View& view : views)
            view.detail.kind = GetParam().level_of_detail;
        return views;
    }
};

TEST_P(Shapes, EveryTraversalGivesThePictureOfRestarts) {
    const scenes::Scene scene = needles();
    Settings with = options();
    with.march.traversal = Traversal::restart;
    Renderer expected = make_renderer(scene, with);
    with.march.traversal = Traversal::stackless;
    Renderer stackless = make_renderer(scene, with);
    with.march.traversal = Traversal::mini_stack;
    Renderer mini_stack = make_renderer(scene, with);
    const std::vector<View> views = Shapes::views(scene);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const optics::Image image = expected.render(views[i]).image;
        EXPECT_EQ(difference(stackless.render(views[i]).image, image), "") << "stackless, view " << i;
        EXPECT_EQ(difference(mini_stack.render(views[i]).image, image), "") << "mini-stack, view " << i;
        if (i != 0) continue;
        // Again with rays that also ask for the bricks of the nodes that they pass.
        EXPECT_EQ(difference(stackless.render(views[i], {.budget = Milliseconds(1e9)}).image, image), "")
            << "stackless";
        EXPECT_EQ(difference(mini_stack.render(views[i], {.budget = Milliseconds(1e9)}).image, image), "")
            << "mini-stack";
    }
}

TEST_P(Shapes, LateStartsAndEarlyEndsChangeNothing) {
    for (const scenes::Scene& scene : {needles(), ball_over_floor()}) {
        Settings with = options();
        with.march.block_starts = false;
        Renderer plain = make_renderer(scene, with);
        with.march.block_starts = true;
        Renderer ours = make_renderer(scene, with);
        std::vector<View> views = Shapes::views(scene);
        for (View& view : views) {  // needles are as thin as they are: larger, they cover enough pixels
            view.size.width = view.size.width * 3 / 2;
            view.size.height = view.size.height * 3 / 2;
        }
        std::size_t seen = 0;
        for (std::size_t i = 0; i < views.size(); ++i) {
            const optics::Image expected = plain.render(views[i]).image;
            // With an empty tree, then with all that the view shows in it, where starts are latest.
            EXPECT_EQ(difference(ours.render(views[i]).image, expected), "") << "cold, view " << i;
            EXPECT_EQ(difference(ours.render(views[i]).image, expected), "") << "view " << i;
            for (std::size_t k = 3; k < expected.rgba.size(); k += 4)
                seen += expected.rgba[k] != 0 ? 1 : 0;
        }
        EXPECT_GT(seen, 2500U) << "the views show too little to prove anything";
    }
}

INSTANTIATE_TEST_SUITE_P(
    NAndM, Shapes,
    ::testing::Values(Shape{4, 16, LevelOfDetail::Kind::nearest}, Shape{4, 8, LevelOfDetail::Kind::nearest},
                      Shape{2, 8, LevelOfDetail::Kind::nearest}, Shape{2, 32, LevelOfDetail::Kind::nearest},
                      Shape{4, 16, LevelOfDetail::Kind::blended}, Shape{4, 8, LevelOfDetail::Kind::blended},
                      Shape{2, 8, LevelOfDetail::Kind::blended}, Shape{8, 8, LevelOfDetail::Kind::blended}),
    [](const auto& shape) {
        return fmt::format("N{}M{}{}", shape.param.n, shape.param.m,
                           shape.param.level_of_detail == LevelOfDetail::Kind::blended ? "Blended" : "");
    });

class TraversalTest : public GlTest {};

TEST_F(TraversalTest, MoreLevelsThanTheMiniStackHolds) {
    const scenes::Scene scene = needles();
    View view = hard_views(scene)[0];
    view.size.width = view.size.height = 48;
    view.camera.yfov = 0.01;
    view.camera.target = view.camera.target + glm::dvec3(0.02, 0.01, 0.0);
    view.detail.pixel_error = 0.2;
    const Settings deep{.tree = {.n = 2, .m = 8, .max_resolution = 1 << 15},
                        .march = {.traversal = Traversal::restart}};
    Settings with = deep;
    with.march.traversal = Traversal::mini_stack;
    const optics::Image expected = make_renderer(scene, deep).render(view).image;
    EXPECT_EQ(difference(make_renderer(scene, with).render(view).image, expected), "");
}

TEST_F(TraversalTest, RowsAloneStartAsInTheWholePicture) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    View view = hard_views(scene)[0];
    Renderer renderer = make_renderer(scene, {});
    const optics::Image whole = renderer.render(view).image;
    for (const renderer::Rows rows : {renderer::Rows{0, 5}, renderer::Rows{13, 40}, renderer::Rows{66, 1}}) {
        const optics::Image part = renderer.render(view, {.rows = rows}).image;
        const auto* first = whole.rgba.data() + std::size_t(rows.first) * std::size_t(view.size.width) * 4;
        EXPECT_TRUE(std::equal(part.rgba.begin(), part.rgba.end(), first)) << "rows from " << rows.first;
    }
}

TEST_F(TraversalTest, CoarserShadowRaysShadeAlmostTheSame) {
    const scenes::Scene scene = ball_over_floor();
    View view = hard_views(scene)[0];
    view.detail.pixel_error = 0.4;
    view.light.towards = {0.8, 0.5, 0.1};
    Renderer fine = make_renderer(scene, {});
    const optics::Image expected = fine.render(view).image;
    view.shadow.pixel_error = 4.0;
    Renderer coarse = make_renderer(scene, {});
    const optics::Image ours = coarse.render(view).image;
    std::size_t different = 0;
    for (std::size_t k = 0; k < ours.rgba.size(); k += 4)
        different += std::abs(int(ours.rgba[k]) - int(expected.rgba[k])) > 32 ? 1 : 0;
    EXPECT_GT(different, 0U) << "shadow rays meet the same voxels";
    EXPECT_LT(different, ours.rgba.size() / 4 / 30);
    view.shadow.pixel_error = 0.0;
    EXPECT_THROW((void)coarse.render(view), Error);
}

}  // namespace
}  // namespace cairn::test
