// A camera that stands still: the bricks that it will need when it moves closer are produced beforehand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/options/view_options.h"
#include "app/viewer/viewer.h"
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

class PrefetchFiner : public GlTest {
protected:
    PrefetchFiner() : scene_(scenes::make_builtin("knot")) {
        view_.size.width = 96;
        view_.size.height = 72;
        view_.camera = app::snapped(optics::framing_camera(scenes::take_snapshot(scene_).bounds, 4.0 / 3.0));
        near_ = view_;
        near_.camera.eye = glm::mix(view_.camera.target, view_.camera.eye, 0.5);
    }
    [[nodiscard]] Renderer make(const Settings& options = {}) const {
        return voxel_renderer(scene_, scenes::take_snapshot(scene_), options);
    }
    /// Settings with a pool for the view's bricks and about `more` others.
    [[nodiscard]] Settings room_for(std::uint64_t more) const {
        Renderer fresh = make();
        const renderer::Frame frame = fresh.render(view_);
        Settings options;
        const auto resident = double(frame.statistics.bricks_resident);
        options.pools.brick_bytes = pool_for(frame.statistics, 1.1 + double(more) / resident);
        return options;
    }
    /// Prefetches until there is no more. @return the number of bricks; `calls` counts the calls.
    static std::uint64_t prefetch_all(Renderer& renderer, double budget_ms, int& calls) {
        constexpr int most_calls = 20000;
        std::uint64_t bricks = 0;
        for (calls = 1; calls < most_calls; ++calls) {
            const renderer::PrefetchResult done = renderer.prefetch_finer(Milliseconds(budget_ms));
            bricks += done.bricks;
            if (!done.more) return bricks;
        }
        ADD_FAILURE() << "it never comes to rest";
        return bricks;
    }

    scenes::Scene scene_;
    View view_;
    View near_;
};

TEST_F(PrefetchFiner, ApproachFindsItsBricks) {
    Renderer plain = make();
    (void)plain.render(view_, {.budget = Milliseconds(1e9)});
    const renderer::Frame expected = plain.render(near_, {.budget = Milliseconds(1e9)});
    const std::uint64_t late = expected.statistics.bricks_produced;
    ASSERT_GT(late, 50U) << "nothing finer is to be seen";

    for (const double budget_ms : {1e9, 1e-3}) {
        Renderer ahead = make();
        EXPECT_FALSE(ahead.prefetch_finer(Milliseconds(1e9)).more) << "nothing has been rendered";
        (void)ahead.render(view_, {.budget = Milliseconds(1e9)});
        int calls = 0;
        const std::uint64_t prefetched = prefetch_all(ahead, budget_ms, calls);
        const renderer::Frame last = ahead.render(near_, {.budget = Milliseconds(1e9)});
        EXPECT_EQ(last.image.rgba, expected.image.rgba);
        fmt::print("{} bricks produced without, {} with, {} ahead in {} calls\n", late,
                   last.statistics.bricks_produced, prefetched, calls);
        EXPECT_EQ(last.statistics.bricks_prefetched, prefetched);
        EXPECT_LE(last.statistics.bricks_produced * 4, late);
    }
}

TEST_F(PrefetchFiner, StopsWhenThePoolIsFullAndTakesNothingFromTheView) {
    constexpr std::uint64_t more = 40;
    Renderer renderer = make(room_for(more));
    View behind = view_;
    behind.camera.eye = 2.0 * view_.camera.target - view_.camera.eye;
    (void)renderer.render(behind);  // its bricks may be evicted
    optics::Image before;
    // In bands, as in the viewer: bricks that any band used stay.
    for (int row = 0; row < view_.size.height; row += 24) {
        const renderer::Frame frame =
            renderer.render(view_, {.rows = renderer::Rows{row, 24}, .budget = Milliseconds(1e9)});
        ASSERT_TRUE(frame.statistics.converged);
    }
    int calls = 0;
    const std::uint64_t prefetched = prefetch_all(renderer, 5.0, calls);
    EXPECT_GE(prefetched, more / 2);
    EXPECT_LE(prefetched, 2 * more);
    EXPECT_EQ(renderer.prefetch_finer(Milliseconds(1e9)).bricks, 0U) << "it does not rest";
    renderer.forget_picture();
    const renderer::Frame last = renderer.render(view_, {.budget = Milliseconds(1e9)});
    EXPECT_EQ(last.image.rgba, make().render(view_).image.rgba);
    EXPECT_EQ(last.statistics.bricks_produced, 0U) << "the view lost bricks";
    EXPECT_GT(last.statistics.brick_bytes_resident * 10, last.statistics.brick_pool_bytes * 9) << "not full";
}

TEST_F(PrefetchFiner, NothingIsProducedWithoutTimeOrForWhatIsFineEnough) {
    Renderer renderer = make();
    (void)renderer.render(view_);
    EXPECT_EQ(renderer.prefetch_finer(Milliseconds(0.0)).bricks, 0U);
    EXPECT_THROW((void)renderer.prefetch_finer(Milliseconds(-1.0)), Error);
    Renderer coarse = make({.tree = {.max_resolution = 64}});  // the view shows its finest voxels already
    (void)coarse.render(view_);
    EXPECT_LE(coarse.prefetch_finer(Milliseconds(1e9)).bricks, 1U)
        << "but for the root's, which may stand in";
    EXPECT_FALSE(coarse.prefetch_finer(Milliseconds(1e9)).more);
}

TEST_F(PrefetchFiner, ViewerThatStandsStillLooksAheadAndThenRests) {
    Renderer renderer = make(room_for(60));
    app::Viewer viewer(renderer, view_, 4.0);
    double now = 0.0;
    const auto rest = [&] {
        int steps = 0;
        for (; viewer.rest(now) < 1e6 && steps < 5000; ++steps) {
            now += std::max(viewer.rest(now), 1e-3);
            viewer.step(now);
        }
        EXPECT_LT(steps, 5000) << "it never comes to rest";
    };
    rest();
    EXPECT_TRUE(viewer.converged());
    const optics::Image expected = make().render(view_).image;
    EXPECT_EQ(viewer.growing().image().rgba, expected.rgba);
    EXPECT_FALSE(renderer.prefetch_finer(Milliseconds(1e9)).more) << "it rests too early";
    const std::uint64_t produced = viewer.bricks_produced();
    renderer.forget_picture();
    const renderer::Frame frame = renderer.render(view_, {.budget = Milliseconds(1e9)});
    EXPECT_EQ(frame.image.rgba, expected.rgba);
    EXPECT_EQ(frame.statistics.bricks_produced, 0U) << "the view lost bricks";
    EXPECT_GT(frame.statistics.bricks_prefetched, 20U);
    for (int i = 0; i < 5; ++i)
        viewer.step(now += 1.0);
    EXPECT_EQ(viewer.bricks_produced(), produced) << "it does not rest";

    // A camera that moves does not wait for prefetching.
    viewer.wheel(3.0);
    EXPECT_EQ(viewer.rest(now), 0.0);
    const std::size_t frames = viewer.frame_ms().size();
    viewer.step(now += 0.01);
    EXPECT_EQ(viewer.frame_ms().size(), frames + 1);
    rest();
    EXPECT_TRUE(viewer.settled());
}

}  // namespace
}  // namespace cairn::test
