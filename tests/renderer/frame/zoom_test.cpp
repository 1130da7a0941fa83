// Depth without limit: a set that repeats itself at every power of two looks the same at all of them.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/march/windows.h"
#include "renderer/produce/fractal_content.h"
#include "renderer/renderer.h"
#include "shaders/interop/windows.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::FractalContent;
using renderer::Renderer;
using renderer::Tile;
using renderer::View;

struct Depth {
    int n, m, max_level;
};

void PrintTo(const Depth& depth, std::ostream* out) {
    *out << fmt::format("N = {}, M = {}, {} levels", depth.n, depth.m, depth.max_level);
}

Settings deep_options(const Depth& depth) {
    Settings options;
    options.tree.n = depth.n;
    options.tree.m = depth.m;
    options.tree.max_level = depth.max_level;
    options.pools.brick_bytes = 32U << 20U;
    return options;
}

Renderer make_renderer(const Settings& options) {
    return Renderer(renderer::fractal_content(options.tree), options.options());
}

/// A view of the middle of the root cube, around which the set repeats itself, from `n^-level` of the root
/// cube away.
View zoomed_view(int n, int level) {
    View view;
    view.size.width = 96;
    view.size.height = 72;
    const std::int64_t across = std::int64_t(1) << (n == 4 ? 2 * level : level);
    view.anchor = Tile{level, glm::i64vec3(across / 2)};
    view.camera.eye = {0.71, 0.53, 0.62};
    view.camera.target = {0.02, 0.01, 0.03};
    view.light.towards = {0.5, 0.9, 0.35};
    return view;
}

struct Difference {
    std::size_t pixels = 0;
    std::size_t silhouettes = 0;  ///< those of `pixels` that only one picture shows
    std::string first;
};

Difference compare(const optics::Image& a, const optics::Image& b, int threshold = 0) {
    Difference out;
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    for (std::size_t pixel = 0; 4 * pixel < a.rgba.size(); ++pixel) {
        int most = 0;
        for (std::size_t k = 0; k < 4; ++k)
            most = std::max(most, std::abs(int(a.rgba[4 * pixel + k]) - int(b.rgba[4 * pixel + k])));
        if (most <= threshold) continue;
        if (out.pixels++ == 0)
            out.first = fmt::format("pixel ({}, {}) differs by {}", pixel % std::size_t(a.width),
                                    pixel / std::size_t(a.width), most);
        out.silhouettes += (a.rgba[4 * pixel + 3] != 0) != (b.rgba[4 * pixel + 3] != 0) ? 1 : 0;
    }
    return out;
}

/// Checks that a picture is neither all background nor of one colour: two empty pictures would be equal, too.
void expect_a_picture(const optics::Image& image) {
    std::size_t covered = 0;
    int least = 255;
    int most = 0;
    for (std::size_t pixel = 0; 4 * pixel < image.rgba.size(); ++pixel) {
        if (image.rgba[4 * pixel + 3] == 0) continue;
        ++covered;
        least = std::min(least, int(image.rgba[4 * pixel]));
        most = std::max(most, int(image.rgba[4 * pixel]));
    }
    EXPECT_GT(covered * 8, image.rgba.size() / 4);
    EXPECT_GT(most - least, 60);
}

class Zoom : public GlTest, public ::testing::WithParamInterface<Depth> {
protected:
    [[nodiscard]] int bits_a_level() const { return GetParam().n == 4 ? 2 : 1; }
    /// The level at which a view shows 2^-40 of the root cube, or slightly more.
    [[nodiscard]] int deepest() const { return 40 / bits_a_level(); }
};

TEST_P(Zoom, PicturesAtEachPowerAreTheSameBitForBitDownTo2ToTheMinus40) {
    Renderer renderer = make_renderer(deep_options(GetParam()));
    const optics::Image first = renderer.render(zoomed_view(GetParam().n, 2)).image;
    expect_a_picture(first);
    for (int level = 3; level <= deepest(); ++level) {
        const optics::Image image = renderer.render(zoomed_view(GetParam().n, level)).image;
        const Difference difference = compare(image, first);
        ASSERT_EQ(difference.pixels, 0U) << "level " << level << ": " << difference.first << ", "
                                         << difference.silhouettes << " of silhouettes";
    }
}

TEST_P(Zoom, SmallStepsOfTheCameraChangeADeepPictureAsAShallowOne) {
    Renderer renderer = make_renderer(deep_options(GetParam()));
    optics::Image before;
    std::size_t changed = 0;
    for (int step = 0; step < 6; ++step) {
        auto moved = [&](int level) {
            View view = zoomed_view(GetParam().n, level);
            // A pixel is about 2^-7 of the anchor's side wide.
            view.camera.eye += glm::dvec3(1.0, -0.5, 0.25) * (step * 0x1p-11);
            return renderer.render(view).image;
        };
        const optics::Image shallow = moved(3);
        const optics::Image deep = moved(deepest());
        const Difference difference = compare(deep, shallow);
        EXPECT_EQ(difference.pixels, 0U) << "step " << step << ": " << difference.first;
        if (step > 0) changed += compare(shallow, before).pixels;
        before = shallow;
    }
    EXPECT_GT(changed, 0U) << "the steps are too small to be seen";
}

TEST_P(Zoom, NearLightCastsTheSameShadowsAtEveryDepth) {
    Renderer renderer = make_renderer(deep_options(GetParam()));
    auto lit = [&](int level) {
        View view = zoomed_view(GetParam().n, level);
        view.light.positional = true;
        view.light.position = {0.45, 0.8, 0.3};
        return renderer.render(view).image;
    };
    const optics::Image shallow = lit(3);
    const optics::Image deep = lit(deepest());
    const Difference difference = compare(deep, shallow);
    EXPECT_EQ(difference.pixels, 0U) << difference.first;
    View dark = zoomed_view(GetParam().n, 3);
    dark.light.positional = true;
    dark.light.position = {0.45, 0.8, 0.3};
    dark.shadow.kind = renderer::ShadowQuality::Kind::none;
    EXPECT_GT(compare(renderer.render(dark).image, shallow, 20).pixels, 50U)
        << "there is no shadow to speak of";
}

TEST_P(Zoom, WindowsShowWhatTheRootAloneShows) {
    Settings shallow = deep_options(GetParam());
    shallow.tree.max_level.reset();
    shallow.tree.max_resolution = 1 << 18;
    Renderer whole = make_renderer(shallow);
    Renderer deep = make_renderer(deep_options(GetParam()));
    View outside;
    outside.size.width = 96;
    outside.size.height = 72;
    outside.camera.eye = {2.6, 2.1, 2.9};
    outside.camera.target = {0.5, 0.5, 0.5};
    View far = outside;
    far.camera.eye = {80.0, 60.0, 90.0};
    far.camera.yfov = 0.015;
    View beside = outside;
    beside.camera.eye = {1.3, 1.2, 1.1};
    for (const View& view :
         {zoomed_view(GetParam().n, 1), zoomed_view(GetParam().n, 2), outside, far, beside}) {
        const optics::Image expected = whole.render(view).image;
        expect_a_picture(expected);
        // The eye is rounded to floats in other units: a ray that grazes a voxel's edge may take its other
        // side.
        const Difference difference = compare(deep.render(view).image, expected, 2);
        EXPECT_LE(difference.pixels, expected.rgba.size() / 4 / 100)
            << difference.first << "; eye " << view.camera.eye.x;
    }
}

TEST_P(Zoom, SmallPoolsAndFramesWithoutTimeEndWithTheSamePicture) {
    Settings options = deep_options(GetParam());
    const View view = zoomed_view(GetParam().n, deepest() - 1);
    Renderer roomy = make_renderer(options);
    const optics::Image expected = roomy.render(view).image;
    Renderer hasty = make_renderer(options);
    renderer::Frame refined = hasty.render(view, {.budget = Milliseconds(0.0)});
    for (int frame = 0; frame < 400 && !refined.statistics.converged; ++frame)
        refined = hasty.render(view, {.budget = Milliseconds(0.0)});
    EXPECT_TRUE(refined.statistics.converged);
    EXPECT_EQ(compare(refined.image, expected).pixels, 0U);

    const std::size_t side = std::size_t(options.tree.m) + 2;
    options.pools.brick_bytes = 12 * side * side * side * 6;
    const std::size_t block_bytes = std::size_t(options.tree.n * options.tree.n * options.tree.n) * 16;
    options.pools.node_bytes = (std::size_t(GetParam().max_level) + 6) * block_bytes;
    Renderer tight = make_renderer(options);
    const renderer::Frame tight_frame = tight.render(view);
    EXPECT_EQ(compare(tight_frame.image, expected).pixels, 0U);
    EXPECT_GT(tight_frame.statistics.nodes_evicted, 0U);
    EXPECT_GT(tight_frame.statistics.bricks_evicted, 0U);
}

INSTANTIATE_TEST_SUITE_P(Trees, Zoom, ::testing::Values(Depth{2, 16, 54}, Depth{4, 16, 28}, Depth{2, 8, 56}),
                         [](const auto& depth) {
                             return fmt::format("N{}M{}", depth.param.n, depth.param.m);
                         });

TEST(Windows, NestAndHoldTheEyeWithHalfATileAroundIt) {
    const renderer::TreeShape shape = renderer::make_deep_tree_shape(2, 16, 54);
    for (const glm::dvec3 offset : {glm::dvec3(0.5), glm::dvec3(0.3, 0.99, 0.0), glm::dvec3(1.0, 1e-9, -0.2),
                                    glm::dvec3(1.0 / 3.0, 0.75, 0.25)}) {
        for (const int level : {0, 1, 20, 54}) {
            const std::int64_t place = (std::int64_t(1) << level) / 3;
            const renderer::TilePoint eye{{level, glm::i64vec3(place)}, offset};
            const auto windows = renderer::windows_around(shape, eye);
            const double tile = std::ldexp(1.0, WINDOW_TILE_BITS);
            for (std::size_t i = 0; i < windows.size(); ++i) {
                const glm::dvec3 here = renderer::point_in_window(windows[i], shape, eye);
                for (int axis = 0; axis < 3 && windows[i].level > 0; ++axis) {
                    EXPECT_GE(here[axis], 0.5 * tile) << "level " << windows[i].level;
                    EXPECT_LE(here[axis], 1.5 * tile) << "level " << windows[i].level;
                }
                if (i + 1 == windows.size()) continue;
                EXPECT_EQ(windows[i + 1].level, windows[i].level - 1);
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_GE(windows[i].low[axis], 2 * windows[i + 1].low[axis]);
                    EXPECT_LE(windows[i].low[axis] + 2, 2 * windows[i + 1].low[axis] + 4);
                }
            }
            EXPECT_EQ(windows.back().level, 0);
        }
    }
}

TEST(Windows, EmptyOnesAroundTheEyeAreLeftOut) {
    const renderer::TreeShape shape = renderer::make_deep_tree_shape(2, 16, 54);
    renderer::FractalOracle oracle(shape);
    // In the middle of the empty octant of a tile of level 10, a quarter of its side from what is not empty.
    const renderer::TilePoint eye{{10, glm::i64vec3(0)}, glm::dvec3(0.75)};
    auto windows = renderer::windows_around(shape, eye);
    EXPECT_EQ(windows.front().level, 54 - shape.levels_in_window());
    renderer::drop_empty(windows, shape, oracle);
    EXPECT_EQ(windows.front().level, 11);
    EXPECT_EQ(windows.back().level, 0);
    // On the set, none is.
    const renderer::TilePoint touching{{10, glm::i64vec3(0)}, glm::dvec3(0.25)};
    auto all = renderer::windows_around(shape, touching);
    const std::size_t count = all.size();
    renderer::drop_empty(all, shape, oracle);
    EXPECT_EQ(all.size(), count);
}

TEST_F(GlTest, ImpossibleDepthsAndAnchorsAreRefused) {
    Settings options;
    options.tree.max_level = 29;
    EXPECT_THROW((void)renderer::tree_shape_of(options.tree), Error);
    options.tree.max_level = -1;
    EXPECT_THROW((void)renderer::tree_shape_of(options.tree), Error);
    options.tree.max_level = 28;
    Renderer deep = make_renderer(options);
    View view = zoomed_view(4, 2);
    view.anchor = Tile{29, glm::i64vec3(0)};
    EXPECT_THROW((void)deep.render(view), Error);
    view.anchor = Tile{2, glm::i64vec3(0, 16, 0)};
    EXPECT_THROW((void)deep.render(view), Error);
}

}  // namespace
}  // namespace cairn::test
