// Pictures of volumes: against a plain march on the CPU in double, against closed forms, and against each
// other.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/produce/dense_field.h"
#include "renderer/produce/made_fields.h"
#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/volume_scenes.h"
#include "tests/support/volume_twin.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::DenseField;
using renderer::HollowSphere;
using renderer::Renderer;
using renderer::TransferFunction;
using renderer::View;
using renderer::VolumeOptions;

constexpr VolumeOptions fog{.full_gradient = 0.0};

/// A pool that suffices for the views here, and is quick to make.
constexpr Settings small_pool{.pools = {.brick_bytes = 8U << 20U}};

class VolumePictures : public GlTest {};
class VolumeTrees : public GlTest, public ::testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(VolumeTrees, PictureEqualsAPlainMarchInDouble) {
    const auto [n, m] = GetParam();
    const scenes::Volume volume = blobs({40, 33, 47}, 1);
    const TransferFunction transfer = ramp(20.0);
    Renderer renderer = voxel_renderer(volume, transfer,
                                       {.tree = {.n = n, .m = m}, .pools = {.brick_bytes = 8U << 20U}}, fog);
    const Densities densities = densities_of(DenseField(volume, n), 64);
    View view = glowing_view(volume.bounds(), 48, 40);
    for (const glm::dvec3 direction :
         {glm::dvec3(0.55, 0.45, 1.0), glm::dvec3(-1.0, 0.2, 0.1), glm::dvec3(0, 0.6, -1)}) {
        view.camera.eye = view.camera.target + glm::normalize(direction) * 4.0;
        const PictureDifference difference =
            difference_of(renderer.render(view).image, march_densities(densities, transfer, view));
        // A density that bends along a step is taken for straight; half a step of 8 bits on either side.
        EXPECT_LE(difference.largest, 2) << difference.worst;
    }
}

TEST_P(VolumeTrees, PictureFromBricksEqualsTheOneFromADenseTexture) {
    const auto [n, m] = GetParam();
    const scenes::Volume volume = blobs(glm::ivec3(64), 2, 20);
    const View view = glowing_view(volume.bounds(), 96, 72);
    const optics::Image dense =
        voxel_renderer(volume, ramp(20.0), {.tree = {.n = n, .m = 64}, .pools = {.brick_bytes = 8U << 20U}},
                       fog)
            .render(view)
            .image;
    Renderer bricks = voxel_renderer(volume, ramp(20.0),
                                     {.tree = {.n = n, .m = m}, .pools = {.brick_bytes = 8U << 20U}}, fog);
    const renderer::Frame ours = bricks.render(view);
    const PictureDifference difference = difference_of(ours.image, dense);
    EXPECT_GT(ours.statistics.bricks_produced, 1U);
    EXPECT_LE(difference.largest, 1) << difference.worst;
}

// A density that rises evenly is the same at every level, so that any seam between levels is a fault.
TEST_P(VolumeTrees, BordersBetweenLevelsDoNotShow) {
    const auto [n, m] = GetParam();
    scenes::Volume slope = blobs(glm::ivec3(128), 1, 0);
    for (std::size_t i = 0; i < slope.samples.size(); ++i) {
        const glm::dvec3 place(glm::ivec3(i % 128, i / 128 % 128, i / 128 / 128));
        slope.samples[i] =
            std::uint16_t(std::lround(65535.0 * (0.1 + 0.8 * glm::dot(place, {0.3, 0.2, 0.5}) / 127.0)));
    }
    // The sides are not visible through so much density.
    const TransferFunction transfer({{0.0, {1.0, 0.0, 0.2}, 4.0}, {1.0, {0.0, 1.0, 0.2}, 5.0}});
    View view = glowing_view(slope.bounds(), 64, 48);
    view.camera = {{-0.1, 0.05, -0.9}, {0.1, 0.0, 1.0}, {0, 1, 0}, 0.5};
    const Settings dense_options{.tree = {.n = n, .m = 64}, .pools = {.brick_bytes = 8U << 20U}};
    const optics::Image dense = voxel_renderer(slope, transfer, dense_options, fog).render(view).image;
    view.show = renderer::Show::levels;
    Renderer renderer =
        voxel_renderer(slope, transfer, {.tree = {.n = n, .m = m}, .pools = {.brick_bytes = 8U << 20U}}, fog);
    // Pixels that show more than one level have a mixed colour.
    bool mixed = false;
    for (const double pixel_error : {3.0, 2.0, 4.0, 1.5, 6.0, 8.0}) {
        if (mixed) break;
        view.detail.pixel_error = pixel_error;
        const optics::Image levels = renderer.render(view).image;
        for (std::size_t i = 4; i < levels.rgba.size(); i += 4)
            mixed = mixed || levels.rgba[i] != levels.rgba[0] || levels.rgba[i + 1] != levels.rgba[1];
    }
    EXPECT_TRUE(mixed) << "only one level is in view";
    view.show = renderer::Show::surface;
    const PictureDifference difference = difference_of(renderer.render(view).image, dense);
    EXPECT_LE(difference.largest, 1) << difference.worst;
}

TEST_P(VolumeTrees, PoolFarSmallerThanTheViewEndsWithTheSamePicture) {
    const auto [n, m] = GetParam();
    const scenes::Volume volume = blobs(glm::ivec3(64), 3, 20);
    View view = glowing_view(volume.bounds());
    view.light = {};
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    Renderer roomy =
        voxel_renderer(volume, ramp(20.0), {.tree = {.n = n, .m = m}, .pools = {.brick_bytes = 8U << 20U}});
    const optics::Image expected = roomy.render(view).image;
    const std::size_t side = std::size_t(m) + 2;
    const Settings tight_options{.tree = {.n = n, .m = m},
                                 .pools = {.node_bytes = 9 * 64 * 16, .brick_bytes = 3 * side * side * side}};
    Renderer tight = voxel_renderer(volume, ramp(20.0), tight_options);
    const renderer::Frame frame = tight.render(view);
    EXPECT_EQ(frame.image.rgba, expected.rgba);
    EXPECT_GT(frame.statistics.bricks_evicted, 0U);
    EXPECT_LE(frame.statistics.brick_pool_bytes, tight_options.pools.brick_bytes);
}

INSTANTIATE_TEST_SUITE_P(NAndM, VolumeTrees,
                         ::testing::Values(std::pair(4, 16), std::pair(2, 8), std::pair(2, 16),
                                           std::pair(2, 32)),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}", shape.param.first, shape.param.second);
                         });

TEST_F(VolumePictures, UniformBallLetsThroughWhatItsChordSays) {
    constexpr double radius = 0.8;
    const auto ball = std::make_shared<HollowSphere>(4, 256, 0.0, 0.5 * radius);
    const double sigma = 1.7;
    const TransferFunction transfer({{0.0, glm::dvec3(1.0), 0.0}, {1.0, glm::dvec3(1.0), sigma}});
    Renderer renderer = voxel_renderer(ball, transfer, small_pool, fog);
    const View view = glowing_view({glm::dvec3(-1.0), glm::dvec3(1.0)});
    const optics::Image image = renderer.render(view).image;
    const double voxel = 2.0 / 256.0;
    int looked_at = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const glm::dvec3 direction = pixel_direction(view, x, y);
            const double past = glm::length(glm::cross(view.camera.eye, direction));
            if (past > radius - 4.0 * voxel && past < radius + 2.0 * voxel)
                continue;  // its side is a voxel wide
            const double chord = past < radius ? 2.0 * std::sqrt(radius * radius - past * past) : 0.0;
            const double expected = 255.0 * (1.0 - std::exp(-sigma * chord));
            const int alpha = image.rgba[std::size_t(4 * (y * view.size.width + x) + 3)];
            ASSERT_NEAR(alpha, expected, 1.0) << fmt::format("pixel ({}, {}), chord {}", x, y, chord);
            looked_at += past < radius ? 1 : 0;
        }
    }
    EXPECT_GE(looked_at, 250);
}

TEST_F(VolumePictures, EightTimesFinerStepsChangeOpacityByLessThanAHundredth) {
    // A shell as sharp as voxels can be, and smooth blobs; from fog to an extinction that lets 4% through a
    // voxel.
    const auto shell = std::make_shared<HollowSphere>(4, 64, 0.3, 0.4);
    const auto soft = std::make_shared<DenseField>(blobs(glm::ivec3(64), 4), 4);
    const View view = glowing_view({glm::dvec3(-1.0), glm::dvec3(1.0)}, 96, 72);
    const auto opacity = [&](const std::shared_ptr<const renderer::Field>& field, double extinction,
                             int steps) {
        const VolumeOptions options{.steps_per_voxel = steps, .full_gradient = 0.0};
        return voxel_renderer(field, ramp(extinction), small_pool, options).render(view).image;
    };
    for (const bool sharp : {true, false}) {
        const std::shared_ptr<const renderer::Field> field =
            sharp ? std::shared_ptr<const renderer::Field>(shell) : soft;
        for (const double extinction : {2.0, 20.0, 100.0}) {
            const optics::Image coarse = opacity(field, extinction, VolumeOptions{}.steps_per_voxel);
            const optics::Image fine = opacity(field, extinction, 8 * VolumeOptions{}.steps_per_voxel);
            int largest = 0;
            for (std::size_t i = 3; i < fine.rgba.size(); i += 4)
                largest = std::max(largest, std::abs(int(fine.rgba[i]) - int(coarse.rgba[i])));
            EXPECT_LE(largest, 2) << (sharp ? "shell" : "blobs") << ", extinction " << extinction;
        }
    }
}

TEST_F(VolumePictures, CamerasInsideOnFacesAndFarAwaySeeWhatAPlainMarchSees) {
    const scenes::Volume volume = blobs(glm::ivec3(32), 5);
    const TransferFunction transfer = ramp(8.0);
    Renderer renderer = voxel_renderer(volume, transfer,
                                       {.tree = {.n = 2, .m = 8}, .pools = {.brick_bytes = 8U << 20U}}, fog);
    const Densities densities = densities_of(DenseField(volume, 2), 32);
    View view = glowing_view(volume.bounds(), 40, 30);
    const double voxel = 2.0 / 32.0;
    struct Place {
        const char* name;
        glm::dvec3 eye, target;
        double yfov;
    };
    for (const Place& place : {
             Place{"inside a brick", {0.11, -0.07, 0.23}, {1, 0.4, -0.3}, 0.8},
             Place{"at a voxel's corner", {voxel, 2 * voxel, 3 * voxel}, {1, 0, 0}, 0.8},
             Place{"on the root's face", {-1.0, 0.1, 0.2}, {0, 0.1, 0.2}, 0.8},
             Place{"on a brick's face, along it", {0.0, 0.0, 0.9}, {0, 0, -1}, 1.2},
             Place{"along an axis", {0.0, 0.0, 5.0}, {0, 0, 0}, 0.4},
             Place{"far outside", {3000.0, 2000.0, 4000.0}, {0, 0, 0}, 0.0004},
         }) {
        view.camera = {place.eye, place.target, {0, 1, 0}, place.yfov};
        const PictureDifference difference =
            difference_of(renderer.render(view).image, march_densities(densities, transfer, view));
        EXPECT_LE(difference.largest, 2) << place.name << ": " << difference.worst;
    }
}

TEST_F(VolumePictures, OpacityDoesNotDependOnTheSceneScale) {
    scenes::Volume volume = blobs(glm::ivec3(48), 6);
    View view = glowing_view(volume.bounds());
    view.light = {};
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    const optics::Image expected = voxel_renderer(volume, ramp(20.0), small_pool).render(view).image;
    for (const double scale : {1000.0, 1.0 / 1024.0}) {
        scenes::Volume scaled = volume;
        scaled.spacing *= scale;
        scaled.origin *= scale;
        View from_there = view;
        from_there.camera.eye *= scale;
        from_there.camera.target *= scale;
        const optics::Image image =
            voxel_renderer(scaled, ramp(20.0 / scale), small_pool).render(from_there).image;
        const PictureDifference difference = difference_of(image, expected);
        EXPECT_LE(difference.largest, 1) << "scale " << scale << ": " << difference.worst;
    }
}

TEST_F(VolumePictures, FramesWithinABudgetEndWithTheWholePicture) {
    const scenes::Volume volume = blobs(glm::ivec3(64), 7);
    View view = glowing_view(volume.bounds());
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    view.light = {};
    const optics::Image expected =
        voxel_renderer(volume, ramp(20.0), {.tree = {.m = 8}, .pools = {.brick_bytes = 8U << 20U}})
            .render(view)
            .image;
    Renderer renderer =
        voxel_renderer(volume, ramp(20.0), {.tree = {.m = 8}, .pools = {.brick_bytes = 8U << 20U}});
    renderer::Frame frame;
    int frames = 0;
    do {
        frame = renderer.render(view, {.budget = Milliseconds(0.0)});
        ASSERT_LT(++frames, 1000);
    } while (!frame.statistics.converged);
    EXPECT_GT(frames, 1);
    EXPECT_EQ(frame.image.rgba, expected.rgba);
}

// Crassin et al. 2008, section 7: the cost of a view does not grow with hidden content.
TEST_F(VolumePictures, BricksOfAViewDoNotGrowWithTheVirtualResolution) {
    const auto tile = std::make_shared<DenseField>(blobs(glm::ivec3(64), 9, 20), 4);
    std::uint64_t expected = 0;
    for (const int copies : {32, 128, 512}) {  // 2048^3 to 32768^3 voxels
        const auto field = std::make_shared<renderer::RepeatedField>(tile, copies);
        View view = glowing_view({glm::dvec3(-1.0), glm::dvec3(2.0 * copies - 1.0)}, 96, 72);
        view.detail.pixel_error = 1.0;
        Renderer renderer =
            voxel_renderer(field, ramp(4.0 / copies, 0.0),
                           {.tree = {.max_resolution = 1 << 17}, .pools = {.brick_bytes = 32U << 20U}}, fog);
        const renderer::Frame frame = renderer.render(view);
        const std::uint64_t bricks = frame.statistics.bricks_produced;
        if (expected == 0) expected = bricks;
        EXPECT_GT(bricks, 10U) << copies << " copies";
        EXPECT_LE(bricks, expected * 11 / 10) << copies << " copies";
    }
}

TEST_F(VolumePictures, CopiesLookAsTheyDoSideBySideInMemory) {
    const scenes::Volume one = blobs(glm::ivec3(16), 8, 6);
    scenes::Volume eight = one;
    eight.size = glm::ivec3(64);
    eight.samples.clear();
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                eight.samples.push_back(one.samples[std::size_t(x % 16 + 16 * (y % 16 + 16 * (z % 16)))]);
    const auto copies = std::make_shared<renderer::RepeatedField>(std::make_shared<DenseField>(one, 2), 4);
    View view = glowing_view(eight.bounds(), 96, 72);
    for (const double pixel_error : {1e-6, 1.0, 4.0}) {
        view.detail.pixel_error = pixel_error;
        const optics::Image expected =
            voxel_renderer(eight, ramp(20.0), {.tree = {.n = 2, .m = 8}, .pools = {.brick_bytes = 8U << 20U}})
                .render(view)
                .image;
        const optics::Image image =
            voxel_renderer(copies, ramp(20.0),
                           {.tree = {.n = 2, .m = 8}, .pools = {.brick_bytes = 8U << 20U}})
                .render(view)
                .image;
        // Means of 16-bit means, rounded in other places.
        const PictureDifference difference = difference_of(image, expected);
        EXPECT_LE(difference.largest, 1) << "pixel error " << pixel_error << ": " << difference.worst;
    }
}

}  // namespace
}  // namespace cairn::test
