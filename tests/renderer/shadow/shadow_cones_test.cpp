// Shadow rays that are cones, and many rays per pixel.

#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/square_over_floor.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::View;

class ShadowCones : public GlTest {};

double penumbra_rmse(SquareOverFloorScene& scene, int rays, bool cones) {
    const std::vector<float> found = scene.renderer().light(scene.view(rays, cones)).light.shares;
    double squares = 0.0;
    int penumbra = 0;
    for (int i = 0; i < scene.size() * scene.size(); ++i) {
        const double truth = scene.truth(i % scene.size(), i / scene.size());
        if (truth < 0.01 || truth > 0.99) continue;
        ++penumbra;
        squares += std::pow(double(found[std::size_t(i)]) - truth, 2);
    }
    EXPECT_GT(penumbra, 500);
    return std::sqrt(squares / penumbra);
}

TEST_F(ShadowCones, AreNearerToTheClosedFormThanAsManyRays) {
    SquareOverFloorScene scene(96);
    for (const auto& [cones, rays] : {std::pair{4, 4}, {8, 8}, {16, 16}}) {
        const double by_cones = penumbra_rmse(scene, cones, true);
        const double by_rays = penumbra_rmse(scene, rays, false);
        RecordProperty(fmt::format("cones_{}", cones), fmt::format("{:.4f}", by_cones));
        RecordProperty(fmt::format("rays_{}", rays), fmt::format("{:.4f}", by_rays));
        EXPECT_LT(by_cones, 0.9 * by_rays) << cones << " cones against " << rays << " rays";
    }
}

TEST_F(ShadowCones, AskForFewerBricks) {
    const auto bricks = [](bool cones) {
        SquareOverFloorScene scene(48);
        (void)scene.renderer().light(scene.view(1, false));
        SquareOverFloorScene fresh(48);
        const renderer::LightFrame frame = fresh.renderer().light(fresh.view(4, cones));
        return frame.statistics.bricks_produced;
    };
    EXPECT_LT(bricks(true), bricks(false));
}

View knot_view(int rays, bool cones) {
    View view;
    view.size.width = 60;
    view.size.height = 45;
    view.camera =
        optics::framing_camera(scenes::take_snapshot(scenes::make_builtin("knot")).bounds, 60.0 / 45.0);
    view.light = {.positional = true, .position = {3.0, 5.0, 3.0}, .radius = 0.7};
    view.shadow = {.kind = cones ? renderer::ShadowQuality::Kind::cones : renderer::ShadowQuality::Kind::rays,
                   .samples = rays};
    return view;
}

Renderer knot(const Settings& options) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

TEST_F(ShadowCones, PictureDependsOnTheViewAlone) {
    const View view = knot_view(4, true);
    Renderer large = knot({.tree = {.max_resolution = 1024}});
    const optics::Image picture = large.render(view).image;
    Renderer small = knot({.tree = {.max_resolution = 1024},
                           .pools = {.brick_bytes = 100U << 10U},
                           .march = {.query_capacity = 50}});
    const renderer::Frame small_frame = small.render(view);
    EXPECT_EQ(small_frame.image.rgba, picture.rgba) << "a pool of few bricks";
    EXPECT_GT(small_frame.statistics.bricks_evicted, 0U) << "the pool was not small";
    Renderer hasty = knot({.tree = {.max_resolution = 1024}});
    renderer::Frame refined = hasty.render(view, {.budget = Milliseconds(1.0)});
    for (int frame = 0; frame < 400 && !refined.statistics.converged; ++frame)
        refined = hasty.render(view, {.budget = Milliseconds(5.0)});
    EXPECT_TRUE(refined.statistics.converged);
    EXPECT_EQ(refined.image.rgba, picture.rgba) << "frames within a budget";
}

TEST_F(ShadowCones, EveryKindOfTreeTakesThem) {
    const auto mean = [](const optics::LightShares& found) {
        double sum = 0.0;
        int seen = 0;
        for (const float share : found.shares) {
            if (share < 0.0F) continue;
            sum += double(share);
            ++seen;
        }
        return sum / seen;
    };
    struct Kind {
        const char* name;
        Settings options;
        bool blended;
    };
    const Kind kinds[] = {{"N = 2", {.tree = {.n = 2, .m = 8, .max_resolution = 512}}, false},
                          {"N = 3", {.tree = {.n = 3, .m = 27, .max_resolution = 512}}, false},
                          {"N = 8", {.tree = {.n = 8, .m = 8, .max_resolution = 512}}, false},
                          {"blended", {.tree = {.m = 8, .max_resolution = 512, .mips = true}}, true}};
    for (const Kind& kind : kinds) {
        Renderer renderer = knot(kind.options);
        View view = knot_view(4, true);
        if (kind.blended) view.detail.kind = renderer::LevelOfDetail::Kind::blended;
        const double by_cones = mean(renderer.light(view).light);
        view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 32};
        // Of two mips a cone takes the coarser by its area too, which is lighter near the receiver.
        EXPECT_NEAR(by_cones, mean(renderer.light(view).light), kind.blended ? 0.09 : 0.03) << kind.name;
    }
}

// Turns of the loops of 8 threads side by side count together. They must stay below the limit at which a
// driver ends loops.
TEST_F(ShadowCones, ManyRaysAreAllCounted) {
    SquareOverFloorScene scene(64);
    double before = 1.0;
    for (const int rays : {32, 128, 512}) {
        const double rmse = penumbra_rmse(scene, rays, false);
        EXPECT_LT(rmse, before + 1e-3) << rays << " rays";
        before = rmse;
    }
    Renderer renderer = knot({.tree = {.max_resolution = 1024}});
    View view = knot_view(64, false);
    const std::vector<float> few = renderer.light(view).light.shares;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 512};
    const std::vector<float> many = renderer.light(view).light.shares;
    double drift = 0.0;
    for (std::size_t i = 0; i < few.size(); ++i)
        drift += double(many[i]) - double(few[i]);
    EXPECT_NEAR(drift / double(few.size()), 0.0, 0.002);
}

}  // namespace
}  // namespace cairn::test
