// Levels of detail: the content of mips, and that nothing pops and there are no seams.
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
using renderer::View;

struct Change {
    int largest = 0;
    double mean = 0.0;
    std::string where;
};

Change change_between(const optics::Image& a, const optics::Image& b) {
    Change change;
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const int d = std::abs(int(a.rgba[i]) - int(b.rgba[i]));
        change.mean += double(d) / double(a.rgba.size());
        if (d <= change.largest) continue;
        change.largest = d;
        const std::size_t pixel = i / 4;
        change.where = fmt::format("pixel ({}, {}), channel {}: {} and {}", pixel % std::size_t(a.width),
                                   pixel / std::size_t(a.width), i % 4, a.rgba[i], b.rgba[i]);
    }
    return change;
}

std::size_t pixels_that_differ(const optics::Image& a, const optics::Image& b, int limit) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        bool differs = false;
        for (std::size_t c = i; c < i + 4; ++c)
            differs = differs || std::abs(int(a.rgba[c]) - int(b.rgba[c])) > limit;
        count += differs ? 1 : 0;
    }
    return count;
}

Renderer make_renderer(const scenes::Scene& scene, Settings options, bool mips = true) {
    options.tree.mips = mips;
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

View view_of(const scenes::Scene& scene, int width, int height, LevelOfDetail::Kind level_of_detail) {
    View view;
    view.size.width = width;
    view.size.height = height;
    view.camera = optics::framing_camera(scenes::take_snapshot(scene).bounds, double(width) / height);
    view.detail.kind = level_of_detail;
    return view;
}

class LevelOfDetailTest : public GlTest {};

/// Mean changes of a frame while the pixels' cones grow by `growth` per step and everything else stays the
/// same: only the level of detail changes.
struct Jumps {
    double largest = 0.0;  ///< largest mean change of a step
    int largest_pixel = 0;
    std::string where;
    double mean = 0.0;  ///< mean change of all steps
};

Jumps jumps_of(Renderer& renderer, View view, int steps) {
    Jumps jumps;
    optics::Image before;
    for (int step = 0; step <= steps; ++step) {
        view.detail.pixel_error = std::pow(16.0, double(step) / steps);
        optics::Image image = renderer.render(view).image;
        if (step > 0) {
            const Change change = change_between(before, image);
            jumps.largest = std::max(jumps.largest, change.mean);
            if (change.largest > jumps.largest_pixel) {
                jumps.largest_pixel = change.largest;
                jumps.where = fmt::format("pixel error {}, {}", view.detail.pixel_error, change.where);
            }
            jumps.mean += change.mean / steps;
        }
        before = std::move(image);
    }
    return jumps;
}

TEST_F(LevelOfDetailTest, NothingPopsWhileTheConeGrowsSixteenfold) {
    // Across two levels of N = 4, each in 100 steps. Blended, all pixels change a little in every step; with
    // the nearest level, those at the same distance change all at once.
    const scenes::Scene scene = ball_over_floor();
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 1024}});
    const int steps = 200;
    View view = view_of(scene, 96, 72, LevelOfDetail::Kind::blended);
    // Edges of shadows move with the voxels that cast them.
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    const Jumps blended = jumps_of(renderer, view, steps);
    view.detail.kind = LevelOfDetail::Kind::nearest;
    const Jumps nearest = jumps_of(renderer, view, steps);
    fmt::print(
        "largest change of a pixel in a step: blended {}, nearest {}; of a frame's mean {:.3f}, {:.3f}; "
        "mean of all steps {:.3f}, {:.3f}\n",
        blended.largest_pixel, nearest.largest_pixel, blended.largest, nearest.largest, blended.mean,
        nearest.mean);
    EXPECT_LE(blended.largest_pixel * 3, nearest.largest_pixel) << "a pixel pops: " << blended.where;
    EXPECT_GT(blended.mean, 0.0);
}

class BlendedShapes : public GlTest, public ::testing::WithParamInterface<std::pair<int, int>> {
protected:
    [[nodiscard]] static Settings options(int max_resolution) {
        return {.tree = {.n = GetParam().first, .m = GetParam().second, .max_resolution = max_resolution}};
    }
};

TEST_P(BlendedShapes, NoVoxelIsNarrowerThanThePixelMeansTheFinestAlone) {
    const scenes::Scene scene = ball_over_floor();
    Renderer renderer = make_renderer(scene, options(64));
    View view = view_of(scene, 120, 90, LevelOfDetail::Kind::blended);
    view.detail.pixel_error = 1e-6;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    const optics::Image blended = renderer.render(view).image;
    view.detail.kind = LevelOfDetail::Kind::nearest;
    const optics::Image nearest = renderer.render(view).image;
    // Blended voxels that look away from the viewer count as silhouettes up to a wider angle: that shows at
    // some of them.
    EXPECT_LE(pixels_that_differ(blended, nearest, 2), blended.rgba.size() / 4 / 200)
        << change_between(blended, nearest).where;
    for (std::size_t i = 3; i < blended.rgba.size(); i += 4)
        ASSERT_EQ(blended.rgba[i], nearest.rgba[i]) << "opacity of pixel " << i / 4;
}

TEST_P(BlendedShapes, PictureDoesNotDependOnHowOftenRaysAreInterrupted) {
    const scenes::Scene scene = ball_over_floor();
    const View view = view_of(scene, 120, 90, LevelOfDetail::Kind::blended);
    Settings tree = options(512);
    Renderer roomy = make_renderer(scene, tree);
    const optics::Image expected = roomy.render(view).image;
    const renderer::Frame frame = roomy.render(view);
    EXPECT_EQ(frame.image.rgba, expected.rgba) << "one pass, no ray waits";
    renderer::TreeOptions with_mips = tree.tree;
    with_mips.mips = true;
    tree.pools.brick_bytes = pool_for(frame.statistics, 0.1, with_mips);
    tree.pools.node_bytes = std::size_t(12 * std::max(tree.tree.n * tree.tree.n * tree.tree.n, 64)) * 16;
    Renderer tight = make_renderer(scene, tree);
    const renderer::Frame tight_frame = tight.render(view);
    EXPECT_EQ(tight_frame.image.rgba, expected.rgba) << "a few bricks at a time";
    EXPECT_GT(tight_frame.statistics.passes, frame.statistics.passes);
    tree.pools.cache_bytes = std::size_t(64) << 20U;
    Renderer cached = make_renderer(scene, tree);
    (void)cached.render(view);
    cached.forget_picture();
    const renderer::Frame cached_frame = cached.render(view);
    EXPECT_EQ(cached_frame.image.rgba, expected.rgba) << "with bricks from main memory";
    EXPECT_GT(cached_frame.statistics.bricks_restored, 0U);
    Renderer hurried = make_renderer(scene, options(512));
    int frames = 0;
    renderer::Frame ours;
    do {
        ours = hurried.render(view, {.budget = Milliseconds(0.0)});
    } while (!ours.statistics.converged && ++frames < 300);
    EXPECT_EQ(ours.image.rgba, expected.rgba) << "after " << frames << " frames without time";
}

TEST_P(BlendedShapes, ClosedSurfaceLetsNoBackgroundThrough) {
    // A floor that fills the view, at every share of two mips.
    const scenes::Scene scene = sheet(glm::vec4(1.0F));
    Renderer renderer = make_renderer(scene, options(512));
    View view;
    view.size.width = 64;
    view.size.height = 48;
    view.camera = {.eye = {0.05, 0.35, 0.4}, .target = {0.0, 0.0, 0.0}};
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    view.detail.kind = LevelOfDetail::Kind::blended;
    for (int step = 0; step < 24; ++step) {
        view.detail.pixel_error = 0.25 * std::pow(64.0, step / 23.0);
        const optics::Image image = renderer.render(view).image;
        for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
            ASSERT_EQ(image.rgba[i], 255)
                << "pixel error " << view.detail.pixel_error << ", pixel " << i / 4 % 64 << ' ' << i / 4 / 64;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(NAndM, BlendedShapes,
                         ::testing::Values(std::pair(4, 16), std::pair(4, 8), std::pair(2, 8),
                                           std::pair(8, 8)),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}", shape.param.first, shape.param.second);
                         });

TEST_F(LevelOfDetailTest, BricksOfAllSizesBlendToTheSamePicture) {
    // The same voxels, cut into tiles of 8, 16 and 32 voxels: borders of bricks and of levels show nowhere. N
    // = 2, so that the levels of all three trees have voxels of the same sizes.
    const scenes::Scene scene = ball_over_floor();
    auto render = [&](int m, LevelOfDetail::Kind level_of_detail) {
        View view = view_of(scene, 160, 120, level_of_detail);
        view.camera.eye = glm::mix(view.camera.target, view.camera.eye, 0.6);
        view.detail.pixel_error = 4.0;
        return make_renderer(scene, {.tree = {.n = 2, .m = m, .max_resolution = 512}}).render(view).image;
    };
    const optics::Image large = render(32, LevelOfDetail::Kind::blended);
    for (const int m : {8, 16}) {
        const Change change = change_between(large, render(m, LevelOfDetail::Kind::blended));
        EXPECT_LE(change.largest, 1) << "M = " << m << ", " << change.where;
    }
    // Several levels are in view: nearest, a tile has one from end to end, and larger ones pass into the next
    // later.
    EXPECT_GT(
        change_between(render(32, LevelOfDetail::Kind::nearest), render(8, LevelOfDetail::Kind::nearest))
            .largest,
        20);
}

TEST_F(LevelOfDetailTest, BlendingNeedsMips) {
    const scenes::Scene scene = ball_over_floor();
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 64}}, false);
    const View view = view_of(scene, 16, 16, LevelOfDetail::Kind::blended);
    try {
        (void)renderer.render(view);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
    }
}

TEST_F(LevelOfDetailTest, MipsGoWithSurfacesAndPowersOfTwo) {
    const auto fault_of = [](const auto& make) {
        try {
            make();
        } catch (const Error& error) {
            return error.fault();
        }
        ADD_FAILURE() << "accepted";
        return Fault::internal;
    };
    const scenes::Scene scene = ball_over_floor();
    EXPECT_EQ(
        fault_of([&] { (void)make_renderer(scene, {.tree = {.n = 3, .m = 27, .max_resolution = 243}}); }),
        Fault::usage);
    scenes::Volume fog;
    fog.size = glm::ivec3(16);
    fog.samples.assign(4096, 30000);
    const renderer::TransferFunction transfer({{.value = 0.0, .extinction = 1.0}});
    EXPECT_EQ(fault_of([&] { (void)voxel_renderer(fog, transfer, {.tree = {.mips = true}}); }), Fault::usage);
    Settings deep{.tree = {.mips = true, .max_level = 20}};
    EXPECT_EQ(fault_of([&] { (void)renderer::tree_shape_of(deep.tree); }), Fault::usage);
}

TEST_F(LevelOfDetailTest, MipsDoNotChangeTheNearestLevelsPicture) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const View view = view_of(scene, 160, 120, LevelOfDetail::Kind::nearest);
    const optics::Image with = make_renderer(scene, {}, true).render(view).image;
    const optics::Image without = make_renderer(scene, {}, false).render(view).image;
    EXPECT_EQ(with.rgba, without.rgba);
}

}  // namespace
}  // namespace cairn::test
