// Occlusion queries that decide which bricks to produce (bench/peers/occlusion_queries.h), against rays,
// which decide it exactly; and the tests of boxes, against exact rays through the pixels.
#include <cmath>
#include <functional>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "bench/peers/box_tests.h"
#include "bench/peers/occlusion_queries.h"
#include "bench/peers/view_tiles.h"
#include "bench/trials/frame_case.h"
#include "renderer/march/march_view.h"
#include "shaders/interop/march.h"
#include "tests/support/gl_fixture.h"

namespace cairn::bench {
namespace {

using renderer::Box;

constexpr int size = 96;
constexpr std::size_t pool_bytes = std::size_t(32) << 20U;

class VisibilityTest : public test::GlTest {
protected:
    static std::unique_ptr<VisibleBricks> bricks(const FrameCase& frame_case, const renderer::View& view) {
        const renderer::TreeOptions options;
        return std::make_unique<VisibleBricks>(frame_case.content(options, {}),
                                               renderer::tree_shape_of(options), view, pool_bytes,
                                               gl::ShaderSource{});
    }
};

/// A view from the middle along an axis: near things are all around the eye.
renderer::View from_within(const FrameCase& frame_case) {
    renderer::View view = frame_case.view(size, size);
    view.camera.eye = 0.5 * (frame_case.bounds().low + frame_case.bounds().high);
    view.camera.target = view.camera.eye + glm::dvec3(1.0, -0.1, -0.3);
    return view;
}

renderer::View nearer(const FrameCase& frame_case) {
    renderer::View view = frame_case.view(size, size);
    view.camera.eye = view.camera.target + 0.3 * (view.camera.eye - view.camera.target);
    return view;
}

/// Rays need no brick that the queries left out: the picture of the bricks that queries chose is that of the
/// rays, bit for bit, without a missing tile. Rays produce the fewest bricks, then queries, then the frustum.
void expect_nothing_missed(const FrameCase& frame_case, renderer::View view,
                           const std::function<std::unique_ptr<VisibleBricks>(const renderer::View&)>& make) {
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    renderer::Renderer rays = frame_case.make({}, {}, {.pools = {.brick_bytes = pool_bytes}});
    const auto [image, by_rays] = rays.render(view);
    const Visibility by_frustum = make(view)->by_frustum();
    EXPECT_EQ(by_frustum.missed, 0U);
    EXPECT_EQ(by_frustum.image.rgba, image.rgba);
    EXPECT_EQ(by_frustum.bricks_produced, by_frustum.tiles_in_frustum);
    for (const QuerySchedule schedule :
         {QuerySchedule{.tests = 16}, QuerySchedule{.tests = 32, .loads_per_test = 0.25},
          QuerySchedule{.tests = 16, .overlapped = false}}) {
        SCOPED_TRACE(fmt::format("{} tests, {} loads per test, {}", schedule.tests, schedule.loads_per_test,
                                 schedule.overlapped ? "overlapped" : "waiting"));
        const Visibility by_queries = make(view)->by_queries(schedule);
        EXPECT_EQ(by_queries.missed, 0U);
        EXPECT_EQ(by_queries.image.rgba, image.rgba);
        EXPECT_EQ(by_queries.tiles_in_frustum, by_frustum.tiles_in_frustum);
        EXPECT_LE(by_rays.bricks_produced, by_queries.bricks_produced);
        EXPECT_LE(by_queries.bricks_produced, by_frustum.bricks_produced);
        EXPECT_LE(by_queries.bricks_used, by_rays.bricks_produced);
        EXPECT_GT(by_queries.bricks_used, 0U);  // the views are not empty
        EXPECT_GT(by_queries.queries, 0U);
    }
}

TEST_F(VisibilityTest, NoRayNeedsWhatTheQueriesLeftOut) {
    for (const char* scene : {"builtin:cornell", "builtin:knot"}) {
        const FrameCase frame_case(scene);
        auto make = [&](const renderer::View& view) { return bricks(frame_case, view); };
        for (const auto& [name, view] :
             {std::pair("near", nearer(frame_case)), std::pair("within", from_within(frame_case))}) {
            SCOPED_TRACE(std::string(scene) + ", " + name);
            expect_nothing_missed(frame_case, view, make);
        }
    }
}

TEST_F(VisibilityTest, WhatAWallHidesIsNotProduced) {
    // A view straight at the back of the Cornell box: only its wall is visible.
    const FrameCase frame_case("builtin:cornell");
    const glm::dvec3 middle = 0.5 * (frame_case.bounds().low + frame_case.bounds().high);
    const glm::dvec3 extent = frame_case.bounds().high - frame_case.bounds().low;
    renderer::View view = frame_case.view(size, size);
    view.camera.target = middle;
    view.camera.eye = middle - glm::dvec3(0.0, 0.0, 0.9 * extent.z);
    view.camera.yfov = 0.8;
    const QuerySchedule waiting{.tests = 8, .overlapped = false};
    const Visibility by_queries = bricks(frame_case, view)->by_queries(waiting);
    const Visibility by_frustum = bricks(frame_case, view)->by_frustum();
    EXPECT_EQ(by_queries.missed, 0U);
    EXPECT_LT(2 * by_queries.bricks_produced, by_frustum.bricks_produced);
}

/// Whether a ray through a pixel's centre meets the box before the pixel's depth.
bool reaches(const interop::MarchView& view, const Box& box, const std::vector<float>& inverse_depths,
             double depth_slack) {
    const glm::dvec3 eye(view.eye);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec2 place =
                (glm::dvec2(x, y) + 0.5) / glm::dvec2(view.width, view.height) * 2.0 - 1.0;
            // The ray advances by 1 along the view per unit of its parameter.
            const glm::dvec3 ray =
                glm::dvec3(view.forward) + place.x * glm::dvec3(view.right) - place.y * glm::dvec3(view.up);
            const glm::dvec3 a = (box.low - eye) / ray;
            const glm::dvec3 b = (box.high - eye) / ray;
            const glm::dvec3 in = glm::min(a, b);
            const glm::dvec3 out = glm::max(a, b);
            const double enters = std::max({in.x, in.y, in.z, 0.0});
            if (enters > std::min({out.x, out.y, out.z})) continue;
            const double inverse = inverse_depths[std::size_t(y * view.width + x)];
            if (inverse == 0.0 || enters * (1.0 + depth_slack) <= 1.0 / inverse) return true;
        }
    }
    return false;
}

TEST_F(VisibilityTest, ABoxIsVisibleWhereARayThroughAPixelReachesIt) {
    constexpr std::uint32_t seed = 1807;
    std::mt19937 random(seed);
    auto unit = [&] { return double(random() >> 8U) * 0x1p-24; };
    const FrameCase frame_case("builtin:cornell");
    const renderer::TreeOptions options;
    const renderer::TreeShape shape = renderer::tree_shape_of(options);
    const auto content = frame_case.content(options, {});
    renderer::View seen = from_within(frame_case);
    seen.size.width = 61;
    seen.size.height = 47;
    const interop::MarchView view = renderer::march_view(seen, content->grid(), shape, nullptr);
    const glm::dvec3 eye(view.eye);
    BoxTests tests(view, {});
    std::vector<float> inverse_depths(std::size_t(seen.size.width) * std::size_t(seen.size.height));
    int visible_count = 0, hidden_count = 0, in_doubt = 0;
    for (int round = 0; round < 12; ++round) {
        const double typical = 300.0 * std::exp2(4.5 * unit());
        for (float& inverse : inverse_depths)
            inverse = unit() < 0.005 ? 0.0F : float(1.0 / (typical * (0.8 + 0.4 * unit())));
        tests.set_depths(inverse_depths);
        std::vector<Box> boxes;
        for (int i = 0; i < 200; ++i) {
            const double side = std::exp2(4.0 + 6.0 * unit());
            // Some boxes are beside the picture, some around the eye.
            const glm::dvec2 place = 2.4 * glm::dvec2(unit(), unit()) - 1.2;
            const glm::dvec3 middle = eye + std::exp2(12.5 * unit()) *
                                                (glm::dvec3(view.forward) + place.x * glm::dvec3(view.right) +
                                                 place.y * glm::dvec3(view.up));
            const glm::dvec3 low = glm::floor(middle / side) * side;
            boxes.push_back({low, low + side});
        }
        tests.begin(boxes);
        const std::vector<bool> visible = tests.visible();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Box& box = boxes[i];
            const glm::dvec3 far = glm::max(glm::abs(box.low - eye), glm::abs(box.high - eye));
            // A pixel is about 1/32 of the distance wide here, and the tests add a 64th of a pixel.
            const double pixel = 2.0 * glm::length(glm::dvec3(view.up)) / seen.size.height;
            const double slack = glm::length(far) * pixel / 16.0;
            const bool must = reaches(view, box, inverse_depths, 1e-5);
            const bool may = reaches(view, {box.low - slack, box.high + slack}, inverse_depths, -1e-5);
            EXPECT_TRUE(visible[i] || !must)
                << "seed " << seed << ", round " << round << ", box " << i << ": a ray reaches it";
            EXPECT_TRUE(!visible[i] || may)
                << "seed " << seed << ", round " << round << ", box " << i << ": no ray comes near it";
            visible_count += must ? 1 : 0;
            hidden_count += may ? 0 : 1;
            in_doubt += must != may ? 1 : 0;
        }
    }
    EXPECT_GT(visible_count, 100);
    EXPECT_GT(hidden_count, 100);
    EXPECT_LT(in_doubt, 200);
}

TEST_F(VisibilityTest, BoxesAroundTheEyeAreVisibleWithoutATest) {
    const FrameCase frame_case("builtin:cornell");
    const renderer::TreeOptions options;
    const auto content = frame_case.content(options, {});
    const interop::MarchView view = renderer::march_view(from_within(frame_case), content->grid(),
                                                         renderer::tree_shape_of(options), nullptr);
    BoxTests tests(view, {});
    tests.set_depths(std::vector<float>(std::size_t(size) * size, 1.0F / 16.0F));
    const glm::dvec3 eye(view.eye);
    const glm::dvec3 ahead = eye + 400.0 * glm::dvec3(view.forward);
    EXPECT_EQ(tests.begin(std::vector<Box>{{eye - 50.0, eye + 70.0}, {ahead - 50.0, ahead + 50.0}}), 1U);
    EXPECT_EQ(tests.visible(), (std::vector<bool>{true, false}));
}

TEST_F(VisibilityTest, TheNearestTileIsTheFirstOfTheList) {
    const FrameCase frame_case("builtin:knot");
    const renderer::TreeOptions options;
    const renderer::TreeShape shape = renderer::tree_shape_of(options);
    const auto content = frame_case.content(options, {});
    for (const renderer::View& view :
         {frame_case.view(size, size), nearer(frame_case), from_within(frame_case)}) {
        const ViewTest test(renderer::march_view(view, content->grid(), shape, nullptr), shape);
        renderer::Tree tree(shape, 1, std::size_t(8) << 20U, content->oracle().child_mask(renderer::Tile{}));
        const std::vector<ViewTile> tiles = list_tiles(tree, content->oracle(), test);
        ASSERT_FALSE(tiles.empty());
        const double side = test.voxel_side(tree.tile(tiles.front().entry));
        EXPECT_EQ(nearest_voxel_side(content->oracle(), test), side);
        for (const ViewTile& tile : tiles)
            EXPECT_GE(tile.distance, tiles.front().distance);
    }
}

TEST_F(VisibilityTest, SaysWhatItCannotDecide) {
    const FrameCase volume("builtin:hollow-sphere");
    EXPECT_THROW((void)bricks(volume, volume.view(size, size)), Error);
    const FrameCase scene("builtin:cornell");
    renderer::View far = scene.view(size, size);
    far.camera.eye = far.camera.target + 100.0 * (far.camera.eye - far.camera.target);
    EXPECT_THROW((void)bricks(scene, far), Error);
}

}  // namespace
}  // namespace cairn::bench
