// Frames through pools that hold a part of what the view needs: they are marched in parts, and produce little
// more than with room for all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "optics/camera.h"
#include "renderer/open_content.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::FrameStatistics;
using renderer::Renderer;
using renderer::View;

class SmallPools : public GlTest {
protected:
    static View view_of(const scenes::Bounds& bounds) {
        View view;
        view.size.width = 400;
        view.size.height = 300;
        view.detail.pixel_error = 0.5;
        view.camera = optics::framing_camera(bounds, 4.0 / 3.0);
        view.light.position = view.camera.target + glm::dvec3(1.0, 2.0, 0.5) * (bounds.high.y - bounds.low.y);
        view.light.positional = true;
        return view;
    }

    /// Renders with all the room that there is, then with shares of what that took. A frame produces at most
    /// `most` times the bricks that it uses, and draws the same picture.
    template <typename Make>
    static void expect_few_produced(const Make& make, const View& view, double most) {
        const renderer::Frame whole = make(renderer::PoolSizes{}).render(view);
        for (const double share : {0.5, 0.1}) {
            renderer::PoolSizes pools;
            pools.brick_bytes = pool_for(whole.statistics, share);
            Renderer small = make(pools);
            for (int frame = 0; frame < 2; ++frame) {
                small.forget_picture();
                const renderer::Frame ours = small.render(view);
                const auto where = fmt::format("share {}, frame {}", share, frame);
                fmt::print("{}: {} bricks produced, {} used, {} passes (of {})\n", where,
                           ours.statistics.bricks_produced, whole.statistics.bricks_used,
                           ours.statistics.passes, whole.statistics.passes);
                EXPECT_LE(double(ours.statistics.bricks_produced),
                          most * double(whole.statistics.bricks_used))
                    << where;
                EXPECT_TRUE(ours.image.rgba == whole.image.rgba) << where;
            }
        }
    }
};

TEST_F(SmallPools, SurfaceWithHardShadowsProducesAtMostTwiceWhatItUses) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    expect_few_produced(
        [&](const renderer::PoolSizes& pools) { return voxel_renderer(scene, snapshot, {.pools = pools}); },
        view_of(snapshot.bounds), 2.0);
}

TEST_F(SmallPools, SurfaceWithSoftShadowsProducesAtMostTwiceWhatItUses) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view = view_of(snapshot.bounds);
    view.light.radius = 0.3 * (snapshot.bounds.high.y - snapshot.bounds.low.y);
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 4};
    expect_few_produced(
        [&](const renderer::PoolSizes& pools) { return voxel_renderer(scene, snapshot, {.pools = pools}); },
        view, 2.0);
}

TEST_F(SmallPools, VolumeProducesAtMostTwiceWhatItUses) {
    const renderer::ContentSource source("builtin:hollow-sphere",
                                         {.tree = renderer::TreeOptions{.max_resolution = 1024}});
    expect_few_produced(
        [&](const renderer::PoolSizes& pools) { return Renderer(source.content(), {.pools = pools}); },
        view_of(source.bounds()), 2.0);
}

}  // namespace
}  // namespace cairn::test
