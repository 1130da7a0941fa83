#include "renderer/renderer.h"

#include <cmath>
#include <random>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/open_content.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/march_twin.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"
#include "voxelizer/grid.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::View;

struct Difference {
    int largest = 0;
    /// Pixels that differ in a channel by more than the threshold.
    std::size_t pixels_over = 0;
    std::string first;  ///< first such pixel
};

Difference compare(const optics::Image& a, const optics::Image& b, int threshold) {
    Difference difference;
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    for (std::size_t pixel = 0; pixel * 4 < a.rgba.size(); ++pixel) {
        int most = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            most = std::max(most, std::abs(int(a.rgba[pixel * 4 + k]) - int(b.rgba[pixel * 4 + k])));
        }
        difference.largest = std::max(difference.largest, most);
        if (most <= threshold) continue;
        if (difference.pixels_over++ == 0) {
            difference.first =
                fmt::format("pixel ({}, {}): {} {} {} {} against {} {} {} {}", pixel % std::size_t(a.width),
                            pixel / std::size_t(a.width), a.rgba[pixel * 4], a.rgba[pixel * 4 + 1],
                            a.rgba[pixel * 4 + 2], a.rgba[pixel * 4 + 3], b.rgba[pixel * 4],
                            b.rgba[pixel * 4 + 1], b.rgba[pixel * 4 + 2], b.rgba[pixel * 4 + 3]);
        }
    }
    return difference;
}

Renderer make_renderer(const scenes::Scene& scene, const Settings& options) {
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

/// A view that shows every voxel at the finest level, whatever the distance.
View finest_view(const scenes::Scene& scene, int width = 160, int height = 120) {
    View view;
    view.size.width = width;
    view.size.height = height;
    view.camera = optics::framing_camera(scenes::take_snapshot(scene).bounds, double(width) / height);
    view.detail.pixel_error = 1e-6;
    return view;
}

class RendererTest : public GlTest {};

class TreeShapes : public GlTest, public ::testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(TreeShapes, PictureEqualsThePlainCpuMarchOfTheSameBits) {
    const scenes::Scene scene = ball_over_floor();
    const DenseVoxels voxels = dense_voxels(scene, 64);
    Renderer renderer =
        make_renderer(scene, {.tree = {.n = GetParam().first, .m = GetParam().second, .max_resolution = 64}});
    View view = finest_view(scene);
    for (const glm::dvec3 direction :
         {glm::dvec3(0.55, 0.45, 1.0), glm::dvec3(-1.0, 0.2, 0.1), glm::dvec3(0.1, 1.0, -0.3)}) {
        const double distance = glm::length(view.camera.eye - view.camera.target);
        view.camera.eye = view.camera.target + glm::normalize(direction) * distance;
        const optics::Image ours = renderer.render(view).image;
        const optics::Image twin = march_dense(voxels, view);
        // Float against double: a chord's end moves by 1e-5 voxels, which shows where a threshold is crossed
        // (the voxel that weighs most, the first empty cell of a shadow ray), on few pixels.
        const Difference difference = compare(ours, twin, 2);
        EXPECT_LE(difference.pixels_over, ours.rgba.size() / 4 / 200) << difference.first;
    }
}

TEST_F(RendererTest, AResolutionIsExactWhateverTheTreesRootHasRoomFor) {
    constexpr int resolution = 100;
    const scenes::Scene scene = ball_over_floor();
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const View view = finest_view(scene);
    const auto picture_of = [&](int n, int m, int voxels) {
        return make_renderer(scene, {.tree = {.n = n, .m = m, .max_resolution = voxels}}).render(view).image;
    };
    const optics::Image expected = picture_of(2, 8, resolution);
    const voxelizer::Grid wanted = voxelizer::grid_around(snapshot.bounds, resolution);
    for (const auto& [n, m, root] : {std::tuple{2, 8, 128}, {4, 16, 256}, {8, 8, 512}, {3, 27, 243}}) {
        const auto where = fmt::format("N = {}, M = {}", n, m);
        const auto content =
            renderer::surface_content(scene, snapshot, {.n = n, .m = m, .max_resolution = resolution});
        EXPECT_EQ(content->grid().origin, wanted.origin) << where;
        EXPECT_EQ(content->grid().voxel_size, wanted.voxel_size) << where;
        EXPECT_EQ(content->grid().resolution, glm::ivec3(root)) << where;
        if (n == 3) continue;  // voxels without marks look otherwise
        // Roots have lattices of their own, to which vertices are rounded.
        const Difference difference = compare(picture_of(n, m, resolution), expected, 2);
        EXPECT_LE(difference.pixels_over, expected.rgba.size() / 4 / 500)
            << where << ": " << difference.first;
    }
    EXPECT_GT(compare(picture_of(4, 16, 64), expected, 2).pixels_over, expected.rgba.size() / 4 / 150);
}

TEST_P(TreeShapes, PictureFromManyBricksEqualsTheOneFromADenseGrid) {
    const scenes::Scene scene = ball_over_floor();
    const View view = finest_view(scene);
    const optics::Image dense =
        make_renderer(scene, {.tree = {.m = 64, .max_resolution = 64}}).render(view).image;
    const optics::Image bricks =
        make_renderer(scene, {.tree = {.n = GetParam().first, .m = GetParam().second, .max_resolution = 64}})
            .render(view)
            .image;
    const Difference difference = compare(dense, bricks, 1);
    EXPECT_EQ(difference.pixels_over, 0U) << difference.first;
}

TEST_P(TreeShapes, PoolFarSmallerThanTheViewEndsWithTheSamePicture) {
    const scenes::Scene scene = ball_over_floor();
    const View view = finest_view(scene);
    Settings options{.tree = {.n = GetParam().first, .m = GetParam().second, .max_resolution = 512}};
    Renderer roomy = make_renderer(scene, options);
    const renderer::Frame expected = roomy.render(view);
    const std::uint64_t needed = expected.statistics.bricks_resident;

    options.pools.brick_bytes = pool_for(expected.statistics, 0.1, options.tree, true);
    options.pools.node_bytes = 9 * 64 * 16;
    Renderer tight = make_renderer(scene, options);
    const renderer::Frame ours = tight.render(view);
    EXPECT_EQ(ours.image.rgba, expected.image.rgba);
    EXPECT_LE(ours.statistics.bricks_resident * 4, needed) << "the pool was not far smaller than the view";
    EXPECT_GT(ours.statistics.bricks_evicted, 0U);
    EXPECT_LE(ours.statistics.brick_pool_bytes, options.pools.brick_bytes);
    EXPECT_LE(ours.statistics.node_pool_bytes, options.pools.node_bytes);
}

INSTANTIATE_TEST_SUITE_P(NAndM, TreeShapes,
                         ::testing::Values(std::pair(4, 16), std::pair(2, 8), std::pair(2, 16),
                                           std::pair(2, 32)),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}", shape.param.first, shape.param.second);
                         });

TEST_F(RendererTest, ConvergedFrameProducesNothingAndRepeatsThePicture) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    Renderer renderer = make_renderer(scene, {});
    View view = finest_view(scene);
    view.detail.pixel_error = 1.0;
    const renderer::Frame first = renderer.render(view);
    EXPECT_GT(first.statistics.bricks_produced, 0U);
    renderer.forget_picture();
    const renderer::Frame second = renderer.render(view);
    EXPECT_EQ(second.image.rgba, first.image.rgba);
    EXPECT_EQ(second.statistics.bricks_produced, 0U);
    EXPECT_EQ(second.statistics.nodes_subdivided, 0U);
    EXPECT_EQ(second.statistics.tile_queries, 0U);
    EXPECT_EQ(second.statistics.passes, 2) << "one for primary rays, one for shadow rays";
}

TEST_F(RendererTest, PictureDoesNotDependOnTheFramesBeforeIt) {
    const scenes::Scene scene = scenes::make_builtin("spheres");
    // The second view fills the whole pool.
    const Settings options{.tree = {.max_resolution = 1024}, .pools = {.brick_bytes = 1U << 18U}};
    View near_view = finest_view(scene);
    near_view.detail.pixel_error = 1.0;
    View other = near_view;
    other.camera.eye = other.camera.target - 0.7 * (other.camera.eye - other.camera.target);
    Renderer used = make_renderer(scene, options);
    (void)used.render(near_view);
    const renderer::Frame after = used.render(other);
    EXPECT_GT(after.statistics.bricks_evicted, 0U);
    const optics::Image fresh = make_renderer(scene, options).render(other).image;
    const Difference difference = compare(after.image, fresh, 0);
    EXPECT_EQ(difference.pixels_over, 0U) << difference.first << "; largest " << difference.largest;
    const optics::Image roomy = make_renderer(scene, {.tree = {.max_resolution = 1024}}).render(other).image;
    const Difference with_room = compare(roomy, fresh, 0);
    EXPECT_EQ(with_room.pixels_over, 0U) << with_room.first << "; largest " << with_room.largest;
}

TEST_F(RendererTest, FarViewNeedsFewerBricksThanANearOne) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    View view = finest_view(scene);
    view.detail.pixel_error = 1.0;
    Renderer near_renderer = make_renderer(scene, {});
    const renderer::Frame near_frame = near_renderer.render(view);
    View far_view = view;
    far_view.camera.eye = view.camera.target + 16.0 * (view.camera.eye - view.camera.target);
    Renderer far_renderer = make_renderer(scene, {});
    const renderer::Frame far_frame = far_renderer.render(far_view);
    EXPECT_LT(far_frame.statistics.bricks_produced * 20, near_frame.statistics.bricks_produced);
}

TEST_F(RendererTest, EmptySceneIsBackgroundAndProducesNothing) {
    scenes::Scene scene;
    scene.scenes.emplace_back();
    Renderer renderer = make_renderer(scene, {});
    View view;
    view.size.width = 33;
    view.size.height = 17;
    const renderer::Frame image = renderer.render(view);
    for (std::size_t i = 0; i < image.image.rgba.size(); i += 4) {
        ASSERT_EQ(image.image.rgba[i + 3], 0) << "pixel " << i / 4;
        ASSERT_EQ(image.image.rgba[i], image.image.rgba[0]) << "pixel " << i / 4;
    }
    EXPECT_EQ(image.statistics.bricks_produced, 0U);
    EXPECT_EQ(image.statistics.passes, 0) << "nothing can be seen: no ray is needed to know that";
}

TEST_F(RendererTest, ShadowOfASquareLiesWhereGeometryPutsIt) {
    // A unit square one above a floor, light straight down, and a camera lower than the square: the floor is
    // dark exactly under it.
    const scenes::Scene scene = square_over_floor();
    View view;
    view.size.width = view.size.height = 300;
    view.camera.eye = {0.0, 0.9, 3.2};
    view.camera.target = {0.0, 0.0, 0.0};
    view.light.towards = {0.0, 1.0, 0.0};
    view.light.ambient = 0.0F;
    const optics::Image image = make_renderer(scene, {}).render(view).image;
    const glm::dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const glm::dvec3 up = glm::cross(right, forward);
    const double half = std::tan(0.5 * view.camera.yfov);
    int dark = 0;
    int lit = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const double px = (x + 0.5) / view.size.width * 2.0 - 1.0;
            const double py = 1.0 - (y + 0.5) / view.size.height * 2.0;
            const glm::dvec3 ray = forward + half * (px * right + py * up);
            if (ray.y >= 0.0) continue;
            const glm::dvec3 floor_point = view.camera.eye - ray * (view.camera.eye.y / ray.y);
            const bool on_floor = std::abs(floor_point.x) < 1.9 && std::abs(floor_point.z) < 1.9;
            if (!on_floor) continue;
            const double edge = std::max(std::abs(floor_point.x), std::abs(floor_point.z)) - 0.5;
            if (std::abs(edge) < 0.05) continue;  // a few pixels around the shadow's edge
            const int red = image.rgba[std::size_t(y * view.size.width + x) * 4];
            if (edge < 0.0) {
                ++dark;
                ASSERT_LE(red, 8) << "light leaks at pixel (" << x << ", " << y << ")";
            } else {
                ++lit;
                ASSERT_GE(red, 200) << "false shadow at pixel (" << x << ", " << y << ")";
            }
        }
    }
    EXPECT_GT(dark, 500);
    EXPECT_GT(lit, 2000);
}

TEST_F(RendererTest, FlatColoursComeThroughUnchanged) {
    // A sheet that fills the view, lit by ambient light alone: the pixel is the base colour times 1.
    const glm::vec4 linear(0.5F, 0.1F, 0.02F, 1.0F);
    const scenes::Scene scene = sheet(linear);
    View view;
    view.size.width = view.size.height = 40;
    view.camera.eye = {0.0, 3.0, 0.0};
    view.camera.up = {0.0, 0.0, -1.0};
    view.camera.target = {0.0, 0.0, 0.0};
    view.camera.yfov = 0.3;
    view.light.ambient = 1.0F;
    const optics::Image image = make_renderer(scene, {}).render(view).image;
    for (int channel = 0; channel < 3; ++channel) {
        const double c = linear[channel];
        const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
        // 8 bits of a square root are at most 1.5 steps of sRGB in the dark.
        EXPECT_NEAR(image.rgba[std::size_t(20 * 40 + 20) * 4 + std::size_t(channel)], 255.0 * srgb, 2.0)
            << "channel " << channel;
    }
    EXPECT_EQ(image.rgba[std::size_t(20 * 40 + 20) * 4 + 3], 255);
}

TEST_F(RendererTest, AlphaMaskCutsThePictureWhereTheTextureSaysSo) {
    // A square whose picture's right half is cut away, seen from above: left half white, right half
    // background.
    scenes::Scene scene = sheet(glm::vec4(1.0F));
    scenes::Image image{"halves", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}};
    scene.images.push_back(image);
    scene.textures.push_back({0, scenes::Wrap::clamp_to_edge, scenes::Wrap::clamp_to_edge});
    scene.materials[0].texture = 0;
    scene.materials[0].alpha_mode = scenes::AlphaMode::mask;
    scenes::Primitive& square = scene.meshes[0].primitives[0];
    for (const glm::vec3& p : square.positions)
        square.texcoords.emplace_back(0.5F + 0.5F * p.x, 0.5F);
    View view;
    view.size.width = view.size.height = 64;
    view.camera.eye = {0.0, 3.0, 0.0};
    view.camera.up = {0.0, 0.0, -1.0};
    const optics::Image picture = make_renderer(scene, {}).render(view).image;
    const double half = 64.0 / (2.0 * std::tan(0.5 * view.camera.yfov) * 3.0);  // pixels across a unit
    for (int x = 0; x < 64; ++x) {
        const double place = (x + 0.5 - 32.0) / half;
        if (std::abs(place) < 0.05 || std::abs(std::abs(place) - 1.0) < 0.05)
            continue;  // the edges' own pixels
        const bool surface = place > -1.0 && place < 0.0;
        EXPECT_EQ(picture.rgba[std::size_t(32 * 64 + x) * 4 + 3], surface ? 255 : 0) << "x = " << place;
    }
}

TEST_F(RendererTest, LongRaysPauseAndStillEndWithTheSamePicture) {
    // Rays just above a sheet cross thousands of tiles that are not empty: more than one pass may walk.
    const scenes::Scene scene = sheet(glm::vec4(1.0F));
    View view;
    view.size.width = view.size.height = 2;
    view.camera.eye = {-1.2, 1e-4, 0.0};
    view.camera.target = {1.2, 1e-4, 0.0};
    view.camera.yfov = 1e-7;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 65536}});
    const optics::Image first = renderer.render(view).image;
    renderer.forget_picture();
    const renderer::Frame second = renderer.render(view);
    EXPECT_EQ(second.statistics.bricks_produced, 0U);
    EXPECT_GT(second.statistics.passes, 1) << "no ray was long enough to pause";
    EXPECT_EQ(first.rgba, second.image.rgba);
}

TEST_F(RendererTest, PictureLargerThanTheDriversBufferIsMarchedInBands) {
    const scenes::Scene scene = ball_over_floor();
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 64}});
    const View small = finest_view(scene, 800, 1000);
    View large = small;
    large.size.width *= 2;
    // 3.2 million ray states of 48 bytes: more than 128 MiB.
    large.size.height *= 2;
    const optics::Image coarse = renderer.render(small).image;
    const optics::Image fine = renderer.render(large).image;
    ASSERT_EQ(fine.rgba.size(), 16U * 800U * 1000U);
    // The same voxels in both: away from their edges the larger picture repeats the smaller one's pixels.
    std::size_t far_off = 0;
    for (int y = 0; y < 1000; ++y) {
        for (int x = 0; x < 800; ++x) {
            const int a = coarse.rgba[std::size_t(y * 800 + x) * 4 + 1];
            const int b = fine.rgba[std::size_t(2 * y * 1600 + 2 * x) * 4 + 1];
            far_off += std::abs(a - b) > 12 ? 1 : 0;
        }
    }
    EXPECT_LT(far_off, 800U * 1000U / 50U);
}

TEST_F(RendererTest, FarCameraWithANarrowLensSeesWhatANearerOneSees) {
    const scenes::Scene scene = ball_over_floor();
    Renderer renderer = make_renderer(scene, {});
    View view;
    view.size.width = view.size.height = 100;
    auto from = [&](double distance) {
        view.camera.target = {0.0, 1.0, 0.0};
        view.camera.eye = view.camera.target + glm::normalize(glm::dvec3(0.3, 0.4, 1.0)) * distance;
        view.camera.yfov = 2.0 * std::atan(3.0 / distance);
        return renderer.render(view).image;
    };
    const Difference difference = compare(from(1e3), from(1e6), 24);
    EXPECT_LE(difference.pixels_over, 150U)
        << difference.first;  // silhouettes: the rays differ by 0.1 degrees
}

TEST_F(RendererTest, LargeBricksHoldLargeTrianglesWhole) {
    const scenes::Scene scene = scenes::make_builtin("cornell");
    View view = finest_view(scene, 128, 128);
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    const optics::Image small =
        make_renderer(scene, {.tree = {.m = 16, .max_resolution = 256}}).render(view).image;
    const optics::Image large =
        make_renderer(scene, {.tree = {.m = 64, .max_resolution = 256}}).render(view).image;
    const Difference difference = compare(small, large, 1);
    EXPECT_EQ(difference.pixels_over, 0U) << difference.first;
}

TEST_F(RendererTest, CamerasInsideOnFacesAndAlongAxesComeToAnEnd) {
    const scenes::Scene scene = ball_over_floor();
    const scenes::Bounds bounds = scenes::take_snapshot(scene).bounds;
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 256}});
    std::vector<glm::dvec3> eyes = {centre,
                                    bounds.low,
                                    bounds.high,
                                    {centre.x, bounds.low.y, centre.z},
                                    {centre.x + 1e6, centre.y, centre.z},
                                    {centre.x, centre.y + 10.0, centre.z}};
    std::mt19937 random(7);
    for (int i = 0; i < 10; ++i) {
        auto unit = [&] { return double(random() >> 8U) * 0x1p-24; };
        eyes.push_back(bounds.low + (bounds.high - bounds.low) * glm::dvec3(unit(), unit(), unit()));
    }
    for (const glm::dvec3& eye : eyes) {
        for (const glm::dvec3 towards :
             {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1), glm::dvec3(-1, -1, -1)}) {
            View view;
            view.size.width = 31;  // odd: the middle pixel looks exactly along the axis
            view.size.height = 21;
            view.camera.eye = eye;
            view.camera.target = eye + towards;
            view.camera.up =
                std::abs(towards.y) == 1.0 && towards.x == 0.0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
            view.light.towards = {0.0, 1.0, 0.0};
            ASSERT_NO_THROW((void)renderer.render(view))
                << "seed 7, eye " << eye.x << ' ' << eye.y << ' ' << eye.z;
        }
    }
}

TEST_F(RendererTest, ImpossibleTreesPoolsAndViewsAreRefusedWithAWayOut) {
    const scenes::Scene scene = ball_over_floor();
    EXPECT_THROW(make_renderer(scene, {.tree = {.n = 3}}), Error);
    EXPECT_THROW(make_renderer(scene, {.tree = {.m = 12}}), Error);
    EXPECT_THROW(make_renderer(scene, {.tree = {.max_resolution = 4}}), Error);
    EXPECT_THROW(make_renderer(scene, {.pools = {.node_bytes = 100}}), Error);
    try {
        (void)make_renderer(scene, {.pools = {.brick_bytes = 1000}});
        FAIL() << "a pool of 1000 bytes was accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        EXPECT_NE(error.way_out().find("MiB"), std::string::npos) << error.way_out();
    }
    Renderer renderer = make_renderer(scene, {.tree = {.max_resolution = 64}});
    View view;
    view.camera.target = view.camera.eye;
    EXPECT_THROW((void)renderer.render(view), Error);
    view = View{};
    view.camera.up = view.camera.target - view.camera.eye;
    EXPECT_THROW((void)renderer.render(view), Error);
    view = View{};
    view.camera.eye = {1e39, 0.0, 0.0};
    EXPECT_THROW((void)renderer.render(view), Error) << "too far for a float";
    view = View{};
    view.size.width = 0;
    EXPECT_THROW((void)renderer.render(view), Error);
}

}  // namespace
}  // namespace cairn::test
