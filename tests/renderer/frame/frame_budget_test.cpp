// Frames with a budget: ancestors replace missing bricks, and the picture converges.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::View;

class FrameBudgetTest : public GlTest {
protected:
    FrameBudgetTest() : scene_(scenes::make_builtin("knot")) {
        view_.size.width = 160;
        view_.size.height = 120;
        view_.detail.pixel_error = 0.3;  // some hundred bricks
        view_.camera = optics::framing_camera(scenes::take_snapshot(scene_).bounds, 160.0 / 120.0);
    }

    [[nodiscard]] Renderer make(Settings options = {}) const {
        options.tree.max_resolution = 4096;  // with levels of 4096 / 4^k voxels, of which the view shows some
        return voxel_renderer(scene_, scenes::take_snapshot(scene_), options);
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
    const optics::Image expected = make().render(view_).image;
    Renderer renderer = make();
    const renderer::Frame ours = renderer.render(view_, {.budget = Milliseconds(1e9)});
    EXPECT_TRUE(ours.statistics.converged);
    EXPECT_EQ(ours.image.rgba, expected.rgba);
}

TEST_F(FrameBudgetTest, FramesWithoutTimeConvergeToExactlyTheUnlimitedPicture) {
    const optics::Image expected = make().render(view_).image;
    Renderer renderer = make();
    renderer::Frame ours;
    std::uint64_t bricks = 0;
    int frames = 0;
    do {
        ours = renderer.render(view_, {.budget = Milliseconds(0.0)});
        EXPECT_TRUE(ours.statistics.converged || ours.statistics.bricks_produced > 0 ||
                    ours.statistics.nodes_subdivided > 0)
            << "frame " << frames << " brought nothing forward";
        bricks += ours.statistics.bricks_produced;
    } while (!ours.statistics.converged && ++frames < 300);
    EXPECT_TRUE(ours.statistics.converged);
    EXPECT_GT(frames, 3) << "the budget did not bind";
    EXPECT_EQ(ours.image.rgba, expected.rgba);
    fmt::print("{} frames, {} bricks\n", frames, bricks);
}

TEST_F(FrameBudgetTest, WhatIsMissingIsStoodInForByCoarserVoxels) {
    const optics::Image expected = make().render(view_).image;
    Renderer renderer = make();
    const std::size_t pixels = expected.rgba.size() / 4;
    // Coarse voxels are fat: the first pictures show more, but never a hole.
    std::size_t holes_after_two = 0;
    (void)renderer.render(view_, {.budget = Milliseconds(0.0)});
    for (int frame = 1; frame < 6; ++frame) {
        const renderer::Frame ours = renderer.render(view_, {.budget = Milliseconds(0.0)});
        ASSERT_FALSE(ours.statistics.converged);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel)
            holes_after_two +=
                shows_something(expected, pixel) && !shows_something(ours.image, pixel) ? 1 : 0;
        EXPECT_LT(different_silhouettes(ours.image, expected), pixels / 4) << "frame " << frame;
    }
    EXPECT_LE(holes_after_two, pixels / 1000);
}

TEST_F(FrameBudgetTest, PoolsTooSmallLowerTheLevelOfDetailAndStandStill) {
    Settings options;
    options.pools.brick_bytes = pool_for(make().render(view_).statistics, 0.12);
    Renderer renderer = make(options);
    optics::Image before;
    optics::Image ours;
    for (int frame = 0; frame < 40; ++frame) {
        before = ours;
        const renderer::Frame next = renderer.render(view_, {.budget = Milliseconds(1e9)});
        ours = next.image;
        EXPECT_FALSE(next.statistics.converged);
        EXPECT_LE(next.statistics.brick_pool_bytes, options.pools.brick_bytes);
    }
    const optics::Image expected = make().render(view_).image;
    EXPECT_EQ(ours.rgba, before.rgba) << "the picture flickers";
    EXPECT_LT(different_silhouettes(ours, expected), expected.rgba.size() / 4 / 6);
    // A frame without a budget goes on with the same pools.
    EXPECT_EQ(renderer.render(view_).image.rgba, expected.rgba);
}

TEST_F(FrameBudgetTest, FullPoolThatHoldsTheViewProducesItOnce) {
    View behind = view_;
    behind.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    const renderer::FrameStatistics whole = make().render(behind, {.budget = Milliseconds(1e9)}).statistics;
    const std::uint64_t needed = whole.bricks_produced;
    Settings options;
    options.pools.brick_bytes = pool_for(whole, 1.15);
    Renderer renderer = make(options);
    // The views before it have filled the pool: one that the pool cannot hold, whose frame ends before its
    // time all the same. (Bricks that stand in took the room that others had been driven from in vain,
    // without end.)
    View near_view = view_;
    near_view.camera.eye = glm::mix(view_.camera.target, view_.camera.eye, 0.3);
    const renderer::Frame filling = renderer.render(near_view, {.budget = Milliseconds(1e9)});
    EXPECT_GT(filling.statistics.brick_bytes_resident * 10, filling.statistics.brick_pool_bytes * 8);
    std::uint64_t produced = 0;
    int frames = 0;
    renderer::FrameStatistics last;
    do {
        // Frames in parts, as in a viewer.
        const renderer::Rows rows{(frames % 4) * 30, 30};
        last = renderer.render(behind, {.rows = rows, .budget = Milliseconds(0.0)}).statistics;
        produced += last.bricks_produced;
    } while (++frames < 400 && (frames % 4 != 0 || !last.converged));
    fmt::print("{} bricks of {}, in {} frames, {} slots\n", produced, needed, frames, last.brick_slots);
    EXPECT_LE(produced, needed + needed / 4) << "of " << needed << ", in " << frames << " frames";
    renderer.forget_picture();
    EXPECT_EQ(renderer.render(behind).image.rgba, make().render(behind).image.rgba);
}

TEST_F(FrameBudgetTest, MovingCameraNeverShowsThePreviousView) {
    Renderer renderer = make();
    Renderer fresh = make();
    for (int frame = 0; frame < 4; ++frame) {
        View moved = view_;
        moved.camera.eye += glm::dvec3(0.3 * frame, 0.1 * frame, 0.0);
        (void)renderer.render(moved, {.budget = Milliseconds(0.0)});
        EXPECT_EQ(renderer.render(moved, {.budget = Milliseconds(1e9)}).image.rgba,
                  fresh.render(moved).image.rgba)
            << "frame " << frame;
    }
}

TEST_F(FrameBudgetTest, BudgetThatIsNoTimeIsRefused) {
    Renderer renderer = make();
    EXPECT_THROW((void)renderer.render(view_, {.budget = Milliseconds(-1.0)}), Error);
    EXPECT_THROW((void)renderer.render(view_, {.budget = Milliseconds(std::nan(""))}), Error);
}

}  // namespace
}  // namespace cairn::test
