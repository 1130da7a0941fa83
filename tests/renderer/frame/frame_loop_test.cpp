// The frame loop: its three goals on one content, and its statistics.
#include "renderer/frame/frame_loop.h"

#include <chrono>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/error.h"
#include "shaders/interop/march.h"
#include "tests/support/box_content.h"
#include "tests/support/gl_fixture.h"

namespace cairn::test {
namespace {

using renderer::FrameLoop;
using renderer::FrameStatistics;
using renderer::Rows;
using renderer::View;

class FrameLoopTest : public GlTest {
protected:
    FrameLoopTest() {
        view_.size.width = 60;
        view_.size.height = 44;
        view_.camera.eye = {1.9, 1.4, 2.1};
        view_.camera.target = {0.5, 0.4, 0.5};
        view_.light.towards = {0.4, 1.0, 0.3};
    }
    static std::unique_ptr<FrameLoop> make() {
        const renderer::TreeShape shape = renderer::make_tree_shape(4, 8, 512);
        return std::make_unique<FrameLoop>(std::make_unique<BoxContent>(shape, BoxOptions{}),
                                           renderer::PoolSizes{.brick_bytes = 64U << 20U},
                                           renderer::MarchOptions{}, gl::ShaderSource{});
    }
    [[nodiscard]] Rows all() const { return {0, view_.size.height}; }
    static Clock::time_point in_an_hour() { return Clock::now() + std::chrono::hours(1); }
    static Clock::time_point an_hour_ago() { return Clock::now() - std::chrono::hours(1); }

    View view_;
};

TEST_F(FrameLoopTest, GoalsEndInTheSamePicture) {
    const optics::Image expected = make()->render(view_, all(), SHOW_SURFACE);
    EXPECT_EQ(make()->render_until(view_, all(), SHOW_SURFACE, in_an_hour()).rgba, expected.rgba);

    const auto late = make();
    int frames = 0;
    optics::Image image;
    do {
        image = late->render_until(view_, all(), SHOW_SURFACE, an_hour_ago());
        EXPECT_EQ(late->statistics().converged || image.rgba != expected.rgba, true)
            << "it hides its success";
        ASSERT_LT(++frames, 500) << "no end";
    } while (!late->statistics().converged);
    EXPECT_GT(frames, 2) << "time was not up";
    EXPECT_EQ(image.rgba, expected.rgba);

    const auto ahead = make();
    EXPECT_GT(ahead->prefetch(view_, in_an_hour()), 0U);
    EXPECT_EQ(ahead->render(view_, all(), SHOW_SURFACE).rgba, expected.rgba);
}

TEST_F(FrameLoopTest, WhatIsAheadIsThereWhenTheViewComes) {
    const auto loop = make();
    (void)loop->render(view_, all(), SHOW_SURFACE);
    while (loop->prefetch_finer(in_an_hour()).more) {
    }
    View finer = view_;
    finer.detail.pixel_error /= 4;
    (void)loop->render(finer, all(), SHOW_SURFACE);
    const std::uint64_t after_prefetching = loop->statistics().bricks_produced;
    const auto other = make();
    (void)other->render(view_, all(), SHOW_SURFACE);
    (void)other->render(finer, all(), SHOW_SURFACE);
    EXPECT_GT(other->statistics().bricks_produced, 10U);
    EXPECT_LT(2 * after_prefetching, other->statistics().bricks_produced);
}

TEST_F(FrameLoopTest, StatisticsAreThoseOfTheLastFrameWhateverIsProducedAhead) {
    const auto loop = make();
    (void)loop->render(view_, all(), SHOW_SURFACE);
    const FrameStatistics frame = loop->statistics();
    EXPECT_GT(frame.bricks_produced, 0U);
    EXPECT_GT(frame.passes, 1);
    View other = view_;
    other.camera.eye = {-1.9, 1.4, 2.1};
    const std::uint64_t ahead =
        loop->prefetch(other, in_an_hour()) + loop->prefetch_finer(in_an_hour()).bricks;
    EXPECT_GT(ahead, 0U);
    EXPECT_EQ(loop->statistics().bricks_produced, frame.bricks_produced);
    EXPECT_EQ(loop->statistics().passes, frame.passes);
    EXPECT_EQ(loop->statistics().tile_queries, frame.tile_queries);
    EXPECT_EQ(loop->statistics().bricks_prefetched, 0U);

    (void)loop->render(view_, all(), SHOW_SURFACE);  // nothing is missing
    EXPECT_EQ(loop->statistics().passes, 0);
    EXPECT_EQ(loop->statistics().bricks_produced, 0U);
    EXPECT_EQ(loop->statistics().bricks_prefetched, ahead);
}

TEST_F(FrameLoopTest, RowsTellTheirProgressAndNoTimeIsNoPass) {
    const auto loop = make();
    double last = 0.0;
    (void)loop->render(view_, all(), SHOW_SURFACE, [&](double share) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        last = share;
    });
    EXPECT_GT(last, 0.0);
    EXPECT_EQ(loop->prefetch(view_, an_hour_ago()), 0U);
    EXPECT_TRUE(loop->prefetch_finer(an_hour_ago()).more);
    EXPECT_EQ(loop->prefetch_finer(an_hour_ago()).bricks, 0U);
    EXPECT_FALSE(make()->prefetch_finer(in_an_hour()).more) << "nothing has been rendered";
    EXPECT_THROW((void)loop->render(view_, {40, 8}, SHOW_SURFACE), Error);
}

}  // namespace
}  // namespace cairn::test
