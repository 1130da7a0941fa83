// Light on volumes: gradients as normals, and shadows by the light that is lost on the way.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
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
using renderer::Renderer;
using renderer::TransferFunction;
using renderer::View;

constexpr Settings small_pool{.pools = {.brick_bytes = 8U << 20U}};

class VolumeLight : public GlTest {};

double linear_of(std::uint8_t srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

struct LightError {
    double mean = 0.0;
    double worst = 0.0;
    int count = 0;
};

/// The error of the picture of a ball around the world's origin against Lambert's law.
LightError light_error(const optics::Image& image, const View& view, double radius, double albedo) {
    LightError error;
    const glm::dvec3 light = glm::normalize(view.light.towards);
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const glm::dvec3 direction = pixel_direction(view, x, y);
            const double along = -glm::dot(view.camera.eye, direction);
            const double past = glm::length(glm::cross(view.camera.eye, direction));
            if (past > 0.9 * radius) continue;  // there a ray sees several normals
            const glm::dvec3 point =
                view.camera.eye + direction * (along - std::sqrt(radius * radius - past * past));
            const double expected = albedo * std::max(glm::dot(glm::normalize(point), light), 0.0);
            const double off =
                std::abs(linear_of(image.rgba[std::size_t(4 * (y * view.size.width + x))]) - expected);
            error.worst = std::max(error.worst, off);
            error.mean += off;
            ++error.count;
        }
    }
    error.mean /= std::max(error.count, 1);
    return error;
}

View lit_view() {
    View view = glowing_view({glm::dvec3(-1.0), glm::dvec3(1.0)});
    view.light = {.towards = {0.3, 0.6, 0.8}, .ambient = 0.0F};
    return view;
}

TEST_F(VolumeLight, SmoothBallIsLitAsItsNormalsSay) {
    scenes::Volume ball = blobs(glm::ivec3(64), 1, 0);
    for (int i = 0; i < 64 * 64 * 64; ++i) {
        const glm::dvec3 place = (glm::dvec3(i % 64, i / 64 % 64, i / 4096) + 0.5) / 32.0 - 1.0;
        const double density = std::clamp(0.5 + (0.7 - glm::length(place)) / 0.3, 0.0, 1.0);
        ball.samples[std::size_t(i)] = std::uint16_t(std::lround(density * 65535.0));
    }
    const TransferFunction opaque(
        {{0.0, glm::dvec3(0.5), 0.0}, {0.49, glm::dvec3(0.5), 0.0}, {0.5, glm::dvec3(0.5), 500.0}});
    const LightError error =
        light_error(voxel_renderer(ball, opaque, small_pool).render(lit_view()).image, lit_view(), 0.7, 0.5);
    ASSERT_GT(error.count, 200);
    EXPECT_LT(error.mean, 0.004);
    EXPECT_LT(error.worst, 0.02);
}

// The known limit: if a density falls from 1 to 0 within a voxel, its gradient is a worse normal.
TEST_F(VolumeLight, BallWithASharpSideIsLitLessExactly) {
    const auto ball = std::make_shared<renderer::HollowSphere>(4, 256, 0.0, 0.4);
    const TransferFunction opaque({{0.0, glm::dvec3(0.5), 0.0}, {1.0, glm::dvec3(0.5), 500.0}});
    const LightError error =
        light_error(voxel_renderer(ball, opaque, small_pool).render(lit_view()).image, lit_view(), 0.8, 0.5);
    ASSERT_GT(error.count, 200);
    EXPECT_LT(error.mean, 0.02);
    EXPECT_LT(error.worst, 0.1);
}

/// An opaque floor (density 1) under a layer of fog (density 0.5) with empty space between them.
scenes::Volume fog_over_floor() {
    scenes::Volume volume;
    volume.name = "fog over a floor";
    volume.size = glm::ivec3(64);
    volume.spacing = glm::dvec3(1.0);
    volume.origin = glm::dvec3(0.5);
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x)
                volume.samples.push_back(y < 8 ? 65535 : y >= 40 && y < 56 ? 32768 : 0);
    return volume;
}

TEST_F(VolumeLight, FogTakesOfTheLightWhatItsThicknessSays) {
    const scenes::Volume volume = fog_over_floor();
    // Extinction at density 0.5 is `sigma`; between 0 and 0.5 it rises evenly, so an edge a voxel wide
    // absorbs as if it were sharp. The floor begins far above the fog's density.
    const double sigma = 0.05;
    const double fog_density = 128.0 / 255.0;
    const TransferFunction transfer({{0.0, glm::dvec3(1.0), 0.0},
                                     {fog_density, glm::dvec3(1.0), sigma},
                                     {0.9, glm::dvec3(1.0), sigma},
                                     {1.0, glm::dvec3(1.0), 50.0}});
    View view;
    view.size.width = 32;
    view.size.height = 24;
    // A view from between floor and fog, downwards.
    view.camera = {{32.0, 30.0, 32.0}, {32.0, 8.0, 33.0}, {0, 0, 1}, 0.5};
    view.detail.pixel_error = 1e-6;
    view.light.ambient = 0.0F;
    for (const glm::dvec3 towards : {glm::dvec3(0, 1, 0), glm::dvec3(0.3, 1, 0.2)}) {
        view.light.towards = towards;
        view.shadow.kind = renderer::ShadowQuality::Kind::none;
        const optics::Image lit = voxel_renderer(volume, transfer, small_pool).render(view).image;
        view.shadow.kind = renderer::ShadowQuality::Kind::hard;
        const optics::Image shadowed = voxel_renderer(volume, transfer, small_pool).render(view).image;
        const double expected = std::exp(-sigma * 16.0 / glm::normalize(towards).y);
        for (int i = 0; i < view.size.width * view.size.height; ++i) {
            const double ratio =
                linear_of(shadowed.rgba[std::size_t(4 * i)]) / linear_of(lit.rgba[std::size_t(4 * i)]);
            ASSERT_NEAR(ratio, expected, 0.012)
                << "pixel " << i << ", light from " << towards.x << " " << towards.z;
        }
    }
}

TEST_F(VolumeLight, WhatIsOpaqueStopsTheLight) {
    const scenes::Volume volume = fog_over_floor();
    const TransferFunction transfer({{0.0, glm::dvec3(1.0), 0.0}, {0.5, glm::dvec3(1.0), 10.0}});
    View view;
    view.size.width = 16;
    view.size.height = 12;
    view.camera = {{32.0, 30.0, 32.0}, {32.0, 8.0, 33.0}, {0, 0, 1}, 0.5};
    view.detail.pixel_error = 1e-6;
    view.light = {.towards = {0.1, 1, 0}, .ambient = 0.0F};
    const optics::Image image = voxel_renderer(volume, transfer, small_pool).render(view).image;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        ASSERT_EQ(image.rgba[i], 0) << "pixel " << i / 4;
        ASSERT_EQ(image.rgba[i + 3], 255) << "pixel " << i / 4;
    }
    // A lamp between the floor and the layer is not in its shadow.
    view.light.positional = true;
    view.light.position = {32.0, 36.0, 32.0};
    const optics::Image lamp = voxel_renderer(volume, transfer, small_pool).render(view).image;
    EXPECT_GT(lamp.rgba[std::size_t(4 * (6 * 16 + 8))], 128);
}

/// A view from between the floor of fog_over_floor() and the layer over it, straight down.
View view_of_the_floor() {
    View view;
    view.size.width = 32;
    view.size.height = 24;
    view.camera = {{32.0, 30.0, 32.0}, {32.0, 8.0, 32.0}, {0, 0, 1}, 1.0};
    view.detail.pixel_error = 1e-6;
    view.light.positional = true;
    view.light.position = {32.0, 56.0, 32.0};
    view.light.ambient = 0.0F;
    return view;
}

/// The light that arrives at each pixel of the floor, as a share of the light without a shadow.
std::vector<double> shares_on_the_floor(const scenes::Volume& volume, const TransferFunction& transfer,
                                        View view) {
    const optics::Image shadowed = voxel_renderer(volume, transfer, small_pool).render(view).image;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    const optics::Image lit = voxel_renderer(volume, transfer, small_pool).render(view).image;
    std::vector<double> shares;
    for (std::size_t i = 0; i < lit.rgba.size(); i += 4)
        shares.push_back(linear_of(shadowed.rgba[i]) / linear_of(lit.rgba[i]));
    return shares;
}

TEST_F(VolumeLight, PenumbraOfAnEdgeInAVolumeComesToTheClosedForm) {
    scenes::Volume volume = fog_over_floor();
    // A thin opaque plate over the half x < 32 instead of the fog.
    for (std::size_t i = 0; i < volume.samples.size(); ++i) {
        const std::size_t x = i % 64;
        const std::size_t y = i / 64 % 64;
        volume.samples[i] = y < 8 || (y >= 40 && y < 42 && x < 32) ? 65535 : 0;
    }
    const TransferFunction transfer(
        {{0.0, glm::dvec3(1.0), 0.0}, {0.499, glm::dvec3(1.0), 0.0}, {0.5, glm::dvec3(1.0), 100.0}});
    View view = view_of_the_floor();
    view.light.shape = optics::LightShape::rectangle;
    view.light.half_u = {6.0, 0.0, 0.0};
    view.light.half_v = {0.0, 0.0, 3.0};
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 256};
    const std::vector<double> shares = shares_on_the_floor(volume, transfer, view);
    int penumbra = 0;
    double squares = 0.0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const glm::dvec3 direction = pixel_direction(view, x, y);
            const double at = view.camera.eye.x + direction.x * (8.0 - 30.0) / direction.y;
            // From a point of the floor, the part of the light left of the plate's two edges is hidden.
            double hidden = 0.0;
            for (const double height : {40.0, 42.0}) {
                const double edge = at + (32.0 - at) * (56.0 - 8.0) / (height - 8.0);
                hidden = std::max(hidden, std::clamp((edge - 26.0) / 12.0, 0.0, 1.0));
            }
            const double share = shares[std::size_t(y * view.size.width + x)];
            squares += (share - (1.0 - hidden)) * (share - (1.0 - hidden));
            if (hidden < 0.02 || hidden > 0.98) continue;
            ++penumbra;
            ASSERT_NEAR(share, 1.0 - hidden, 0.06) << "pixel (" << x << ", " << y << ")";
        }
    }
    EXPECT_GT(penumbra, 80);
    EXPECT_LT(std::sqrt(squares / double(shares.size())), 0.02);
}

// A ray does not count as hidden or not, but by the light that it has lost on its way.
TEST_F(VolumeLight, SoftLightThroughFogIsTheMeanOfWhatIsLeftOfIt) {
    const double sigma = 0.08;
    const TransferFunction transfer({{0.0, glm::dvec3(1.0), 0.0},
                                     {128.0 / 255.0, glm::dvec3(1.0), sigma},
                                     {0.9, glm::dvec3(1.0), sigma},
                                     {1.0, glm::dvec3(1.0), 50.0}});
    View view = view_of_the_floor();
    view.light.position = {32.0, 60.0, 32.0};
    view.light.shape = optics::LightShape::disk;
    view.light.half_u = {30.0, 0.0, 0.0};
    view.light.half_v = {0.0, 0.0, 30.0};
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 64};
    const std::vector<double> shares = shares_on_the_floor(fog_over_floor(), transfer, view);
    for (int y = 0; y < view.size.height; y += 3) {
        for (int x = 0; x < view.size.width; x += 3) {
            const glm::dvec3 direction = pixel_direction(view, x, y);
            const glm::dvec3 point = view.camera.eye + direction * (8.0 - 30.0) / direction.y;
            double sum = 0.0;
            constexpr int steps = 64;
            for (int i = 0; i < steps * steps; ++i) {
                const double radius = 30.0 * std::sqrt((i % steps + 0.5) / steps);
                const double angle = 2.0 * 3.14159265358979 * (i / steps + 0.5) / steps;
                const glm::dvec3 there(32.0 + radius * std::cos(angle), 60.0,
                                       32.0 + radius * std::sin(angle));
                sum += std::exp(-sigma * 16.0 * glm::distance(there, point) / (60.0 - 8.0));
            }
            EXPECT_NEAR(shares[std::size_t(y * view.size.width + x)], sum / (steps * steps), 0.012)
                << "pixel (" << x << ", " << y << ")";
        }
    }
}

TEST_F(VolumeLight, SoftShadowIsTheSameFromTinyPoolsAndWithinABudget) {
    const scenes::Volume volume = blobs(glm::ivec3(96), 40);
    const TransferFunction transfer = ramp(20.0);
    View view;
    view.size.width = 40;
    view.size.height = 30;
    view.camera = optics::framing_camera({glm::dvec3(-1.0), glm::dvec3(1.0)}, 4.0 / 3.0);
    view.detail.pixel_error = 0.3;  // 96 voxels on 40 pixels
    view.light.angle = 0.2;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 8};
    Renderer roomy = voxel_renderer(volume, transfer, small_pool);
    const optics::Image expected = roomy.render(view).image;
    Renderer scarce = voxel_renderer(volume, transfer, {.pools = {.brick_bytes = 1U << 18U}});
    const renderer::Frame scarce_frame = scarce.render(view);
    EXPECT_EQ(scarce_frame.image.rgba, expected.rgba);
    EXPECT_GT(scarce_frame.statistics.bricks_evicted, 0U);
    Renderer hurried = voxel_renderer(volume, transfer, small_pool);
    renderer::Frame refined = hurried.render(view, {.budget = Milliseconds(0.0)});
    for (int frame = 0; frame < 2000 && !refined.statistics.converged; ++frame)
        refined = hurried.render(view, {.budget = Milliseconds(0.0)});
    EXPECT_TRUE(refined.statistics.converged);
    EXPECT_EQ(refined.image.rgba, expected.rgba);
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 1};
    EXPECT_NE(roomy.render(view).image.rgba, expected.rgba);
    view.shadow.kind = renderer::ShadowQuality::Kind::cones;
    EXPECT_THROW((void)roomy.render(view), Error);
}

}  // namespace
}  // namespace cairn::test
