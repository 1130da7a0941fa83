// Pictures that are refined in slices of rows while the pools are full: how much is produced until they
// settle.
#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/viewer/refinement.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::BatchPace;
using renderer::Renderer;
using renderer::View;

/// Figures of a refinement until it is settled.
struct Course {
    int steps = 0;
    std::uint64_t produced = 0;
    std::uint64_t evicted = 0;
    bool settled = false;
    bool converged = false;
    optics::Image image;
};

Course refine(Renderer& renderer, const View& view) {
    constexpr int most_steps = 2000;
    app::Pace pace(1e-3, app::Pace::least_pixels);  // almost no time: bands are as low as possible
    app::Refinement refinement(view);
    Course course;
    for (; !refinement.settled() && course.steps < most_steps; ++course.steps) {
        const renderer::FrameStatistics step = refinement.step(renderer, pace);
        course.produced += step.bricks_produced;
        course.evicted += step.bricks_evicted;
    }
    course.settled = refinement.settled();
    course.converged = refinement.converged();
    course.image = refinement.image();
    return course;
}

class CacheConvergence : public GlTest {
protected:
    CacheConvergence() : scene_(scenes::make_builtin("knot")) {
        view_.size.width = 128;
        view_.size.height = 96;
        view_.detail.pixel_error = 0.4;
        view_.camera = optics::framing_camera(scenes::take_snapshot(scene_).bounds, 4.0 / 3.0);
        behind_ = view_;
        behind_.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    }

    [[nodiscard]] Renderer make(Settings options = {}) const {
        options.tree.max_resolution = 4096;  // with levels of 4096 / 4^k voxels, of which the views show some
        return voxel_renderer(scene_, scenes::take_snapshot(scene_), options);
    }
    /// A renderer whose pool holds a share of the bricks that a view needs, and is full of bricks of other
    /// views.
    [[nodiscard]] Renderer full(const renderer::FrameStatistics& needed, double share) const {
        Settings options;
        options.pools.brick_bytes = pool_for(needed, share);
        Renderer renderer = make(options);
        View near_view = view_;
        near_view.camera.eye = glm::mix(view_.camera.target, view_.camera.eye, 0.7);
        (void)renderer.render(near_view);
        near_view.camera.eye.x = 2.0 * view_.camera.target.x - near_view.camera.eye.x;
        (void)renderer.render(near_view);
        const renderer::Frame frame = renderer.render(view_);
        EXPECT_GT(frame.statistics.brick_bytes_resident * 10, frame.statistics.brick_pool_bytes * 8);
        return renderer;
    }
    [[nodiscard]] renderer::FrameStatistics need_of(const View& view) const {
        Renderer fresh = make();
        return fresh.render(view).statistics;
    }

    scenes::Scene scene_;
    View view_;
    View behind_;
};

TEST_F(CacheConvergence, PoolThatHoldsTheViewIsRefinedWithoutProducingTwice) {
    const renderer::FrameStatistics whole = need_of(behind_);
    const std::uint64_t needed = whole.bricks_produced;
    Renderer renderer = full(whole, 1.1);
    const Course course = refine(renderer, behind_);
    fmt::print("{} bricks of {}, {} steps\n", course.produced, needed, course.steps);
    EXPECT_TRUE(course.converged);
    EXPECT_LE(course.produced, needed + needed / 8);
    EXPECT_EQ(course.image.rgba, make().render(behind_).image.rgba);
}

TEST_F(CacheConvergence, PoolThatHoldsOnlyBandsConvergesBandByBand) {
    const renderer::FrameStatistics whole = need_of(behind_);
    const std::uint64_t needed = whole.bricks_produced;
    Renderer renderer = full(whole, 0.8);
    const Course course = refine(renderer, behind_);
    fmt::print("{} bricks of {}, {} evicted, {} steps\n", course.produced, needed, course.evicted,
               course.steps);
    EXPECT_TRUE(course.converged);
    EXPECT_LE(course.produced, needed * 3 / 2) << "bands evict each other's bricks";
    EXPECT_EQ(course.image.rgba, make().render(behind_).image.rgba);
}

TEST_F(CacheConvergence, PoolThatHoldsNoBandComesToRest) {
    const renderer::FrameStatistics whole = need_of(behind_);
    const std::uint64_t needed = whole.bricks_produced;
    Renderer renderer = full(whole, 0.08);
    const Course course = refine(renderer, behind_);
    fmt::print("{} bricks of {}, {} steps\n", course.produced, needed, course.steps);
    EXPECT_TRUE(course.settled) << "it goes on without end";
    EXPECT_FALSE(course.converged) << "the pool was not too small";
    EXPECT_LE(course.produced, needed * 2) << "the same bricks are produced again and again";
    // Once the picture is settled, more visits change nothing.
    int idle = 0;
    for (int visit = 0; visit < 400 && idle < 3; ++visit) {
        const renderer::Frame frame =
            renderer.render(behind_, {.rows = renderer::Rows{40, 24}, .budget = Milliseconds(0.0)});
        idle = frame.statistics.bricks_produced == 0 ? idle + 1 : 0;
    }
    const optics::Image at_rest =
        renderer.render(behind_, {.rows = renderer::Rows{40, 24}, .budget = Milliseconds(0.0)}).image;
    for (int visit = 0; visit < 5; ++visit) {
        const renderer::Frame last =
            renderer.render(behind_, {.rows = renderer::Rows{40, 24}, .budget = Milliseconds(0.0)});
        EXPECT_EQ(last.image.rgba, at_rest.rgba) << visit;
        EXPECT_EQ(last.statistics.bricks_produced, 0U) << visit;
    }
    EXPECT_EQ(renderer.render(behind_).image.rgba, make().render(behind_).image.rgba);
}

/// Answers queries of a fixed cost in some frames, on a clock of its own. @return the longest overrun of the
/// budget.
double overrun(BatchPace& pace, double ms_per_query, double budget_ms, int frames) {
    double worst = 0.0;
    for (int frame = 0; frame < frames; ++frame) {
        double now = 0.0;
        do {
            const std::size_t batch = pace.batch(budget_ms - now);
            now += ms_per_query * double(batch);
            pace.learn(ms_per_query * double(batch), batch);
        } while (now < budget_ms);
        worst = std::max(worst, now - budget_ms);
    }
    return worst;
}

TEST(BatchPaceTest, FrameOverrunsByAFewMillisecondsOnceTheCostIsKnown) {
    for (const double ms_per_query : {0.01, 0.1, 0.5, 2.0, 20.0}) {
        for (const double budget_ms : {0.0, 5.0, 30.0}) {
            BatchPace pace;
            (void)overrun(pace, ms_per_query, budget_ms, 30);
            const double least_batch_ms = ms_per_query * double(BatchPace::least);
            EXPECT_LE(overrun(pace, ms_per_query, budget_ms, 100),
                      std::max(BatchPace::overrun_ms, least_batch_ms) * 1.01)
                << ms_per_query << " ms per query, " << budget_ms << " ms per frame";
        }
    }
}

TEST(BatchPaceTest, CostThatRisesIsLearntInFewBatches) {
    BatchPace pace;
    (void)overrun(pace, 0.05, 30.0, 30);
    EXPECT_EQ(pace.batch(1000.0), BatchPace::most);
    (void)overrun(pace, 5.0, 30.0, 2);
    EXPECT_LE(pace.batch(30.0), 8U);
}

}  // namespace
}  // namespace cairn::test
