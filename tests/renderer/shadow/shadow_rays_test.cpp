// Shadow rays from rasterized surfaces and from voxels to lights that have an extent.

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using optics::Light;
using optics::LightShape;
using optics::LightShares;
using renderer::Renderer;
using renderer::View;

constexpr double square_half = 0.5;  // the square is at height 1
constexpr double light_height = 3.0;
constexpr double light_half = 0.4;

/// A square of voxels over a floor that is a mesh.
class SquareOverFloor {
public:
    SquareOverFloor()
        : renderer_(
              voxel_renderer(square_, scenes::take_snapshot(square_), {.tree = {.max_resolution = 512}})),
          rays_(view()) {
        renderer_.set_mix(
            {.meshes = std::make_shared<renderer::MeshRaster>(floor_, scenes::take_snapshot(floor_)),
             .mesh_shadows = true,
             .voxels_hidden = true});
    }

    static View view() {
        View view;
        view.size.width = 144;
        view.size.height = 144;
        view.camera = {
            .eye = {0.0, 6.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 0.5};
        view.detail.pixel_error = 1e-6;
        view.light.positional = true;
        view.light.position = {0.0, light_height, 0.0};
        view.light.shape = optics::LightShape::rectangle;
        view.light.half_u = {light_half, 0.0, 0.0};
        view.light.half_v = {0.0, 0.0, light_half};
        return view;
    }

    /// The share of the rectangle that is seen past the square. The square's projection on the light's plane
    /// is a square, too.
    [[nodiscard]] double truth(int x, int y) const {
        const glm::dvec3 direction = rays_.direction({x + 0.5, y + 0.5});
        const glm::dvec3 point = rays_.eye - direction * (rays_.eye.y / direction.y);
        const auto hidden = [](double at) {
            const double low = at + (-square_half - at) * light_height;
            const double high = at + (square_half - at) * light_height;
            return std::max(0.0, std::min(high, light_half) - std::max(low, -light_half)) /
                   (2.0 * light_half);
        };
        return 1.0 - hidden(point.x) * hidden(point.z);
    }

    optics::LightShares shares(const View& view) { return renderer_.light(view).light; }
    Renderer& renderer() { return renderer_; }

private:
    scenes::Scene square_ = colored(
        quad({-0.5F, 1, -0.5F}, {-0.5F, 1, 0.5F}, {0.5F, 1, 0.5F}, {0.5F, 1, -0.5F}), glm::vec4(1.0F));
    scenes::Scene floor_ = colored(quad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}), glm::vec4(1.0F));
    Renderer renderer_;
    PictureRays rays_;
};

class ShadowRays : public GlTest {};

TEST_F(ShadowRays, PenumbraOfASquareComesToTheClosedForm) {
    SquareOverFloor scene;
    double before = 1.0;
    // The error of samples falls until the error of voxels is left, about their size on the floor.
    for (const auto& [rays, limit] : {std::pair{4, 0.14}, {16, 0.04}, {64, 0.013}, {256, 0.008}}) {
        View view = SquareOverFloor::view();
        view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
        const optics::LightShares found = scene.shares(view);
        double squares = 0.0;
        int penumbra = 0;
        for (int y = 0; y < view.size.height; ++y) {
            for (int x = 0; x < view.size.width; ++x) {
                const double truth = scene.truth(x, y);
                const double share = found.shares[std::size_t(y * view.size.width + x)];
                ASSERT_GE(share, 0.0) << "pixel (" << x << ", " << y << ")";
                if (truth < 0.01 || truth > 0.99) continue;
                ++penumbra;
                squares += (share - truth) * (share - truth);
            }
        }
        const double rmse = std::sqrt(squares / penumbra);
        RecordProperty(fmt::format("rays_{}", rays), fmt::format("{:.4f} over {} pixels", rmse, penumbra));
        EXPECT_GT(penumbra, 1000);
        EXPECT_LT(rmse, limit) << rays << " rays";
        EXPECT_LT(rmse, before) << rays << " rays";
        before = rmse;
    }
}

TEST_F(ShadowRays, PenumbraIsSymmetric) {
    SquareOverFloor scene;
    View view = SquareOverFloor::view();
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 256};
    for (const optics::LightShape shape :
         {optics::LightShape::rectangle, optics::LightShape::disk, optics::LightShape::sphere}) {
        view.light.shape = shape;
        view.light.radius = light_half;
        const optics::LightShares found = scene.shares(view);
        const auto at = [&](int x, int y) {
            return double(found.shares[std::size_t(y * view.size.width + x)]);
        };
        double sum = 0.0;
        int partial = 0;
        for (int y = 0; y < view.size.height; ++y) {
            for (int x = 0; x < view.size.width / 2; ++x) {
                const double left = at(x, y);
                const double right = at(view.size.width - 1 - x, y);
                if (left > 0.0 && left < 1.0) ++partial;
                sum += left - right;
                ASSERT_NEAR(left, right, 0.08) << "pixel (" << x << ", " << y << "), shape " << int(shape);
            }
        }
        EXPECT_GT(partial, 500) << "shape " << int(shape);
        EXPECT_NEAR(sum / partial, 0.0, 0.005) << "shape " << int(shape);
    }
}

TEST_F(ShadowRays, ALightIsHalfSeenWhereItsMiddleTouchesAnEdge) {
    // The hard shadow's edge is where half of any point-symmetric light is seen past a straight edge.
    SquareOverFloor scene;
    View view = SquareOverFloor::view();
    view.light.shape = optics::LightShape::disk;
    const optics::LightShares hard = scene.shares(view);
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 128};
    const optics::LightShares soft = scene.shares(view);
    const auto row = std::size_t(view.size.height / 2) * std::size_t(view.size.width);
    int edges = 0;
    for (std::size_t x = 1; x < std::size_t(view.size.width); ++x) {
        if ((hard.shares[row + x - 1] < 0.5F) == (hard.shares[row + x] < 0.5F)) continue;
        ++edges;
        EXPECT_NEAR(0.5F * (soft.shares[row + x - 1] + soft.shares[row + x]), 0.5F, 0.06F) << "column " << x;
    }
    EXPECT_EQ(edges, 2);
}

View knot_view(int rays) {
    View view;
    view.size.width = 90;
    view.size.height = 67;
    view.camera =
        optics::framing_camera(scenes::take_snapshot(scenes::make_builtin("knot")).bounds, 90.0 / 67.0);
    view.light = {.positional = true, .position = {3.0, 5.0, 3.0}, .radius = 0.7};
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
    return view;
}

Renderer knot(const Settings& options) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

TEST_F(ShadowRays, OneRayOrAPointIsAHardShadow) {
    Renderer renderer = knot({.tree = {.max_resolution = 512}});
    View point = knot_view(1);
    point.light.radius = 0.0;
    const optics::Image hard = renderer.render(point).image;
    EXPECT_EQ(renderer.render(knot_view(1)).image.rgba, hard.rgba);
    point.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 64};
    EXPECT_EQ(renderer.render(point).image.rgba, hard.rgba);
    EXPECT_NE(renderer.render(knot_view(64)).image.rgba, hard.rgba);
}

TEST_F(ShadowRays, PictureDoesNotDependOnThePoolsNorOnRowsNorOnFramesBefore) {
    const View view = knot_view(24);
    Renderer large = knot({.tree = {.max_resolution = 1024}});
    const optics::Image picture = large.render(view).image;
    large.forget_picture();
    const renderer::Frame large_frame = large.render(view);
    EXPECT_EQ(large_frame.image.rgba, picture.rgba) << "a second frame";
    Renderer small = knot({.tree = {.max_resolution = 1024},
                           .pools = {.brick_bytes = 100U << 10U},
                           .march = {.query_capacity = 50}});
    const renderer::Frame small_frame = small.render(view);
    EXPECT_EQ(small_frame.image.rgba, picture.rgba) << "a pool of few bricks";
    EXPECT_GT(small_frame.statistics.bricks_evicted, 0U) << "the pool was not small";
    EXPECT_GT(small_frame.statistics.passes, large_frame.statistics.passes);
    const optics::Image rows = small.render(view, {.rows = renderer::Rows{31, 9}}).image;
    const auto first = picture.rgba.begin() + 31L * view.size.width * 4;
    EXPECT_TRUE(std::equal(rows.rgba.begin(), rows.rgba.end(), first)) << "rows apart";
    Renderer hasty = knot({.tree = {.max_resolution = 1024}});
    renderer::Frame refined = hasty.render(view, {.budget = Milliseconds(1.0)});
    for (int frame = 0; frame < 400 && !refined.statistics.converged; ++frame)
        refined = hasty.render(view, {.budget = Milliseconds(5.0)});
    EXPECT_TRUE(refined.statistics.converged);
    EXPECT_EQ(refined.image.rgba, picture.rgba) << "frames within a budget";
}

TEST_F(ShadowRays, HundredsOfLongRaysPauseAndComeToAnEnd) {
    // With 512 rays per pixel a thread would turn its loops more often than a pass allows.
    View view = knot_view(512);
    view.size.width = 16;
    view.size.height = 12;
    view.shadow.pixel_error = 1.0 / 64.0;
    Renderer renderer = knot({.tree = {.n = 2, .m = 8, .max_resolution = 2048},
                              .march = {.traversal = renderer::Traversal::restart}});
    const renderer::Frame first = renderer.render(view);
    EXPECT_GT(first.statistics.passes, 3);
    renderer.forget_picture();
    const renderer::Frame frame = renderer.render(view);
    EXPECT_EQ(frame.image.rgba, first.image.rgba);
    EXPECT_GT(frame.statistics.passes, 2) << "no ray paused: the test could not fail";
}

TEST_F(ShadowRays, ImpossibleLightsAndVolumesAreRefused) {
    Renderer renderer = knot({.tree = {.max_resolution = 64}});
    const auto refuses = [&](auto change) {
        View view = knot_view(8);
        change(view);
        EXPECT_THROW((void)renderer.render(view), Error);
    };
    refuses([](View& view) { view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 0}; });
    refuses([](View& view) { view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 513}; });
    refuses([](View& view) { view.light.radius = -1.0; });
    refuses([](View& view) { view.light.radius = std::nan(""); });
    refuses([](View& view) { view.light.half_u.x = INFINITY; });
    refuses([](View& view) { view.light = {.angle = 1.6}; });
    scenes::Volume volume;
    volume.size = {8, 8, 8};
    volume.samples.assign(512, 0x4000);
    Renderer fog = voxel_renderer(volume, renderer::TransferFunction({{0.0F, {1.0F, 1.0F, 1.0F}, 0.0F},
                                                                      {1.0F, {1.0F, 1.0F, 1.0F}, 1.0F}}));
    EXPECT_THROW((void)fog.light(knot_view(1)), Error);
    View cones = knot_view(8);
    EXPECT_NO_THROW((void)fog.render(cones));
    cones.shadow.kind = renderer::ShadowQuality::Kind::cones;
    EXPECT_THROW((void)fog.render(cones), Error);
}

}  // namespace
}  // namespace cairn::test
