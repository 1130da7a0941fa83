// Frames that must not take long: what is missing is stood in for, and the picture converges.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/renderer.h"
#include "scenes/builtin/builtin.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::TreeOptions;
using renderer::View;

class FrameBudgetTest : public GlTest {
protected:
    FrameBudgetTest() : scene_(scenes::make_builtin("knot")) {
        view_.width = 160;
        view_.height = 120;
        view_.pixel_error = 0.3;  // some hundred bricks
        view_.camera = optics::framing_camera(scenes::take_snapshot(scene_).bounds, 160.0 / 120.0);
    }

    [[nodiscard]] Renderer make(const TreeOptions& options = {}) const {
        return Renderer(scene_, scenes::take_snapshot(scene_), options);
    }

    scenes::Scene scene_;
    View view_;
};

bool shows_something(const optics::Image& image, std::size_t pixel) {
    return image.rgba[4 * pixel + 3] != 0;
}

/// Pixels that one of the pictures shows as background and the other does not.
std::size_t different_silhouettes(const optics::Image& a, const optics::Image& b) {
    std::size_t count = 0;
    for (std::size_t pixel = 0; 4 * pixel < a.rgba.size(); ++pixel)
        count += shows_something(a, pixel) != shows_something(b, pixel) ? 1 : 0;
    return count;
}

TEST_F(FrameBudgetTest, FrameWithTimeToSpareIsThePictureOfAnUnlimitedOne) {
    const optics::Image expected = make().render(view_);
    Renderer renderer = make();
    const optics::Image ours = renderer.render_within(view_, 1e9);
    EXPECT_TRUE(renderer.statistics().converged);
    EXPECT_EQ(ours.rgba, expected.rgba);
}

TEST_F(FrameBudgetTest, FramesWithoutTimeConvergeToExactlyTheUnlimitedPicture) {
    const optics::Image expected = make().render(view_);
    Renderer renderer = make();
    optics::Image ours;
    std::uint64_t bricks = 0;
    int frames = 0;
    do {
        ours = renderer.render_within(view_, 0.0);
        EXPECT_TRUE(renderer.statistics().converged || renderer.statistics().bricks_produced > 0 ||
                    renderer.statistics().nodes_subdivided > 0)
            << "frame " << frames << " brought nothing forward";
        bricks += renderer.statistics().bricks_produced;
    } while (!renderer.statistics().converged && ++frames < 300);
    EXPECT_TRUE(renderer.statistics().converged);
    EXPECT_GT(frames, 3) << "the budget did not bind";
    EXPECT_EQ(ours.rgba, expected.rgba);
    fmt::print("{} frames, {} bricks\n", frames, bricks);
}

TEST_F(FrameBudgetTest, WhatIsMissingIsStoodInForByCoarserVoxels) {
    const optics::Image expected = make().render(view_);
    Renderer renderer = make();
    const std::size_t pixels = expected.rgba.size() / 4;
    // Coarse voxels are fat: the first pictures show more, but never a hole.
    std::size_t holes_after_two = 0;
    (void)renderer.render_within(view_, 0.0);
    for (int frame = 1; frame < 6; ++frame) {
        const optics::Image ours = renderer.render_within(view_, 0.0);
        ASSERT_FALSE(renderer.statistics().converged);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel)
            holes_after_two += shows_something(expected, pixel) && !shows_something(ours, pixel) ? 1 : 0;
        EXPECT_LT(different_silhouettes(ours, expected), pixels / 4) << "frame " << frame;
    }
    EXPECT_LE(holes_after_two, pixels / 1000);
}

TEST_F(FrameBudgetTest, PoolsTooSmallLowerTheLevelOfDetailAndStandStill) {
    TreeOptions options;
    const std::size_t side = std::size_t(options.m) + 2;
    options.brick_pool_bytes = 60 * side * side * side * 6;
    Renderer renderer = make(options);
    optics::Image before;
    optics::Image ours;
    for (int frame = 0; frame < 40; ++frame) {
        before = ours;
        ours = renderer.render_within(view_, 1e9);
        EXPECT_FALSE(renderer.statistics().converged);
        EXPECT_LE(renderer.statistics().brick_pool_bytes, options.brick_pool_bytes);
    }
    const optics::Image expected = make().render(view_);
    EXPECT_EQ(ours.rgba, before.rgba) << "the picture flickers";
    EXPECT_LT(different_silhouettes(ours, expected), expected.rgba.size() / 4 / 6);
    // A patient frame goes on with the same pools.
    EXPECT_EQ(renderer.render(view_).rgba, expected.rgba);
}

TEST_F(FrameBudgetTest, FullPoolThatHoldsTheViewProducesItOnce) {
    View behind = view_;
    behind.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    std::uint64_t needed = 0;
    {
        Renderer fresh = make();
        (void)fresh.render_within(behind, 1e9);
        needed = fresh.statistics().bricks_produced;
    }
    TreeOptions options;
    const std::size_t side = std::size_t(options.m) + 2;
    options.brick_pool_bytes = std::size_t(double(needed) * 0.95) * side * side * side * 6;
    Renderer renderer = make(options);
    // The views before it have filled the pool.
    View near_view = view_;
    near_view.camera.eye = glm::mix(view_.camera.target, view_.camera.eye, 0.4);
    (void)renderer.render_within(near_view, 1e9);
    EXPECT_EQ(renderer.statistics().bricks_resident, renderer.statistics().brick_slots);
    std::uint64_t produced = 0;
    int frames = 0;
    do {
        // In parts, as a viewer does.
        (void)renderer.render_rows_within(behind, {(frames % 4) * 30, 30}, 0.0);
        produced += renderer.statistics().bricks_produced;
    } while (++frames < 400 && (frames % 4 != 0 || !renderer.statistics().converged));
    fmt::print("{} bricks of {}, in {} frames, {} slots\n", produced, needed, frames,
               renderer.statistics().brick_slots);
    EXPECT_LE(produced, needed + needed / 4) << "of " << needed << ", in " << frames << " frames";
    renderer.forget_picture();
    EXPECT_EQ(renderer.render(behind).rgba, make().render(behind).rgba);
}

TEST_F(FrameBudgetTest, MovingCameraNeverShowsThePreviousView) {
    Renderer renderer = make();
    Renderer fresh = make();
    for (int frame = 0; frame < 4; ++frame) {
        View moved = view_;
        moved.camera.eye += glm::dvec3(0.3 * frame, 0.1 * frame, 0.0);
        (void)renderer.render_within(moved, 0.0);
        EXPECT_EQ(renderer.render_within(moved, 1e9).rgba, fresh.render(moved).rgba) << "frame " << frame;
    }
}

TEST_F(FrameBudgetTest, BudgetThatIsNoTimeIsRefused) {
    Renderer renderer = make();
    EXPECT_THROW((void)renderer.render_within(view_, -1.0), Error);
    EXPECT_THROW((void)renderer.render_within(view_, std::nan("")), Error);
}

}  // namespace
}  // namespace cairn::test
