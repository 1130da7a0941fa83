#include "renderer/shadow/soft_shadow_map.h"

#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/error.h"
#include "reference/shadow_truth.h"
#include "shaders/interop/shadow_map.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/soft_shadow_scene.h"
#include "tests/support/soft_shadow_twin.h"

namespace cairn::test {
namespace {

using glm::dvec2;
using glm::dvec3;
using optics::half_size;
using optics::Light;
using renderer::fit_shadow_frustum;
using renderer::ShadowFormat;
using renderer::ShadowFrustum;
using renderer::ShadowMesh;
using renderer::ShadowPasses;
using renderer::SoftShadowMap;
using renderer::SoftShadowOptions;

class SoftShadow : public GlTest {};

const Corners floor_of_4 = square({0.0, 0.0, 0.0}, 2.0);

SoftShadowOptions sizes(int occluder_size, int receiver_size, ShadowPasses passes = ShadowPasses::one,
                        ShadowFormat format = ShadowFormat::fp32) {
    return {occluder_size, receiver_size, passes, format};
}

/// Corners of tests/support/soft_shadow_scene.h's square, seen from a light above: a polygon of light space.
std::vector<dvec2> polygon_of(const Corners& square_corners) {
    std::vector<dvec2> polygon;
    for (const std::size_t i : {0U, 1U, 2U, 5U})
        polygon.emplace_back(square_corners[i].x, square_corners[i].z);
    return polygon;
}

std::vector<double> exact_past(const std::vector<ReceiverPoint>& points, const std::vector<dvec2>& polygon,
                               double depth, const dvec2& light_half) {
    std::vector<double> truth;
    for (const ReceiverPoint& point : points)
        truth.push_back(visible_past(polygon, depth, point.position, light_half));
    return truth;
}

/// The visible shares by Embree, to a standard error of 0.004.
std::vector<double> sampled(const ShadowScene& scene, const Light& light,
                            const std::vector<ReceiverPoint>& points) {
    const reference::ImageTracer tracer(scene.scene, scene.occluders);
    const glm::dmat4 world_from_light = glm::inverse(optics::light_from_world(light));
    std::vector<dvec3> world;
    for (const ReceiverPoint& point : points)
        world.emplace_back(world_from_light * glm::dvec4(point.position, 1.0));
    const auto visibilities = reference::area_light_visibility(
        tracer, world, {}, light, {.standard_error = 0.004, .most_samples = 4096});
    std::vector<double> truth;
    for (const reference::LightVisibility& visibility : visibilities)
        truth.push_back(visibility.visible);
    return truth;
}

/// Texels along the silhouette may fall to either side where triangles are snapped to the raster: then the
/// ray through a point next to the texel's centre, by less than the snapping, sees the other side.
bool near_silhouette(const LightTriangles& triangles, const dvec2& tangents, const dvec2& texel,
                     double near_distance) {
    constexpr double snapping = 1.0 / 64.0;
    const bool hit = cast(triangles, tangents, near_distance).closest > 0.0;
    for (int i = 0; i < 8; ++i) {
        const double angle = i * 0.785398163397448;
        const dvec2 aside = snapping * texel * dvec2(std::cos(angle), std::sin(angle));
        if ((cast(triangles, tangents + aside, near_distance).closest > 0.0) != hit) return true;
    }
    return false;
}

void expect_depths(const renderer::ShadowMapValues& map, const renderer::ShadowWindow& window,
                   const LightTriangles& triangles, double near_distance, bool furthest) {
    const dvec2 texel = (window.high - window.low) / double(map.size);
    std::size_t hits = 0;
    for (int y = 0; y < map.size; ++y) {
        for (int x = 0; x < map.size; ++x) {
            const dvec2 tangents = window.low + texel * (dvec2(x, y) + 0.5);
            const DepthRange range = cast(triangles, tangents, near_distance);
            const double expected = furthest ? range.furthest : range.closest;
            const double found = map.at(x, y) < float(SHADOW_NONE) ? double(map.at(x, y)) : 0.0;
            if ((expected > 0.0) != (found > 0.0)) {
                EXPECT_TRUE(near_silhouette(triangles, tangents, texel, near_distance))
                    << "texel (" << x << ", " << y << "): " << found << " instead of " << expected;
            } else if (!near_silhouette(triangles, tangents, texel, near_distance)) {
                EXPECT_NEAR(found, expected, 1e-5 + 2e-3 * expected) << "texel (" << x << ", " << y << ")";
                hits += expected > 0.0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(hits, map.values.size() / 3);
}

// The maps hold the first and the last hits of rays from the light's centre.
TEST_F(SoftShadow, DepthMapsAreWhatTheLightsCentreSees) {
    const ShadowScene scene(ball({0.2, 1.0, -0.1}, 0.6, 3), floor_of_4);
    const Light light = optics::aimed_light({1.0, 3.5, 0.7}, {0.1, 0.9, 0.0}, 0.5, 0.3);
    const SoftShadowMap map = shadow_of(scene, light, sizes(48, 40, ShadowPasses::two));
    const double near = map.frustum().near_distance;
    expect_depths(map.occluder_inverse_depths(0), map.frustum().occluders,
                  in_light_space(scene.occluders, light), near, false);
    expect_depths(map.occluder_inverse_depths(1), map.frustum().occluders,
                  in_light_space(scene.occluders, light), near, true);
    expect_depths(map.receiver_inverse_depths(), map.frustum().receivers,
                  in_light_space(scene.receivers, light), near, false);
}

struct Setting {
    std::string name;
    ShadowScene scene;
    Light light;
    SoftShadowOptions options;
};

/// Slanted receivers, receivers before occluders, occluders beyond the window, and two passes.
std::vector<Setting> settings() {
    Corners steps = floor_of_4;
    for (const Corners& more :
         {square({0.8, 0.7, 0.5}, 0.6), quad({-2, 0, -2}, {-2, 0, 2}, {-1, 1.6, 2}, {-1, 1.6, -2})})
        steps.insert(steps.end(), more.begin(), more.end());
    std::vector<Setting> all;
    const Light slanted = optics::aimed_light({1.2, 3.0, 0.8}, {0.0, 0.6, 0.0}, 0.8, 0.4);
    all.push_back({"ball over steps",
                   {ball({0.0, 0.9, 0.0}, 0.5, 3), steps},
                   slanted,
                   sizes(40, 36, ShadowPasses::two)});
    all.push_back({"box on the floor",
                   {box({-0.3, 0.0, -0.3}, {0.4, 1.0, 0.2}), floor_of_4},
                   slanted,
                   sizes(33, 50, ShadowPasses::two)});
    all.push_back({"ball under a wide light",
                   {ball({0.0, 1.0, 0.0}, 0.4, 2), steps},
                   light_above(3.0, 1.2, 0.2),
                   sizes(24, 64)});
    return all;
}

// Every micro-patch on every receiver, in double and with lengths in place of tangents.
TEST_F(SoftShadow, EqualsItsTwin) {
    for (const Setting& setting : settings()) {
        const SoftShadowMap map = shadow_of(setting.scene, setting.light, setting.options);
        const renderer::ShadowMapValues visible = map.visible();
        const std::vector<double> twin = twin_of(map);
        double least = 1.0;
        for (std::size_t i = 0; i < twin.size(); ++i) {
            least = std::min(least, twin[i]);
            ASSERT_NEAR(double(visible.values[i]), twin[i], 2e-4)
                << setting.name << ", texel (" << int(i) % visible.size << ", " << int(i) / visible.size
                << ")";
        }
        EXPECT_LT(least, 0.3) << setting.name << ": no shadow to compare";
    }
}

TEST_F(SoftShadow, PenumbraExtentsHoldAllThatAPatchCanDarken) {
    for (const Setting& setting : settings()) {
        const SoftShadowMap map = shadow_of(setting.scene, setting.light, setting.options);
        const renderer::ShadowMapValues receivers = map.receiver_inverse_depths();
        std::uint64_t area = 0;
        std::uint64_t darkened = 0;
        const int pass_count = setting.options.passes == ShadowPasses::two ? 2 : 1;
        for (int pass = 0; pass < pass_count; ++pass) {
            for (const interop::MicroPatch& patch : map.micro_patches(pass)) {
                const glm::ivec2 low(patch.extent_low & 0xFFFFU, patch.extent_low >> 16U);
                const glm::ivec2 high(patch.extent_high & 0xFFFFU, patch.extent_high >> 16U);
                area += std::uint64_t((high.x - low.x) * (high.y - low.y));
                for (int y = 0; y < receivers.size; ++y) {
                    for (int x = 0; x < receivers.size; ++x) {
                        if (hidden_by(map, patch, x, y, receivers.at(x, y)) <= 0.0) continue;
                        ++darkened;
                        ASSERT_TRUE(x >= low.x && x < high.x && y >= low.y && y < high.y)
                            << setting.name << ": patch " << (patch.texel & 0xFFFFU) << ", "
                            << (patch.texel >> 16U) << " darkens texel (" << x << ", " << y << ") outside ("
                            << low.x << ", " << low.y << ") to (" << high.x << ", " << high.y << ")";
                    }
                }
            }
        }
        EXPECT_EQ(map.statistics().fragments, area) << setting.name;
        EXPECT_GT(darkened * 4, area) << setting.name << ": extents are far too large";
    }
}

// A square parallel to the light that fills its window is cut in patches without a rest: no error but
// rounding.
TEST_F(SoftShadow, AlignedSquareIsTheClosedForm) {
    const Corners occluder = square({0.1, 1.0, -0.2}, 0.5);
    const ShadowScene scene(occluder, floor_of_4);
    const Light light = light_above(3.0, 0.4, 0.25);
    for (const int size : {1, 7, 32, 100}) {
        const SoftShadowMap map = shadow_of(scene, light, sizes(size, 64));
        EXPECT_EQ(map.statistics().micro_patches, std::uint64_t(size * size));
        const std::vector<ReceiverPoint> points = receiver_points(map);
        const ShadowError error =
            error_of(points, exact_past(points, polygon_of(occluder), 2.0, half_size(light)));
        EXPECT_LT(error.greatest, 5e-5) << size << " texels per side: " << error.worst;
        EXPECT_GT(error.shadowed, points.size() / 2);
    }
}

// What does not fit the raster costs half a texel along the silhouette (section 4.1.1).
TEST_F(SoftShadow, ErrorFallsWithTheSizeOfTheOccluderMap) {
    const Corners occluder = square({0.1, 1.0, -0.2}, 0.5, 0.3);
    const ShadowScene scene(occluder, floor_of_4);
    const Light light = light_above(3.0, 0.3, 0.3);
    double before = 1.0;
    for (const int size : {8, 24, 72, 216}) {
        const SoftShadowMap map = shadow_of(scene, light, sizes(size, 48));
        const std::vector<ReceiverPoint> points = receiver_points(map);
        const ShadowError error =
            error_of(points, exact_past(points, polygon_of(occluder), 2.0, half_size(light)));
        EXPECT_LT(error.mean, before / 2.0) << size << " texels per side: " << error.worst;
        EXPECT_LT(error.mean, 0.75 / size) << size << " texels per side: " << error.worst;
        before = error.mean;
    }
}

// A light of a millionth of the scene: points are lit or dark, as by the ray to its centre.
TEST_F(SoftShadow, TinyLightGivesTheHardShadow) {
    const Corners occluder = square({0.1, 1.0, -0.2}, 0.5);
    const ShadowScene scene(occluder, floor_of_4);
    const Light light = light_above(3.0, 1e-6, 1e-6);
    ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers);
    frustum.receivers = {dvec2(-0.6), dvec2(0.6)};
    const SoftShadowMap map = shadow_of(scene, light, sizes(64, 97), frustum);
    int dark = 0;
    for (const ReceiverPoint& point : receiver_points(map)) {
        const dvec2 crossing = dvec2(point.position) * (2.0 / 3.0);
        const dvec2 outside = glm::abs(crossing - dvec2(0.1, -0.2)) - 0.5;
        const double beyond = std::max(outside.x, outside.y);
        if (std::abs(beyond) < 1e-5) continue;
        EXPECT_NEAR(point.visible, beyond > 0.0 ? 1.0 : 0.0, 1e-5)
            << "texel (" << point.x << ", " << point.y << ")";
        dark += beyond < 0.0 ? 1 : 0;
    }
    EXPECT_GT(dark, 1000);
}

struct OneAndTwo {
    ShadowError one, two;
};
OneAndTwo errors_of_passes(const ShadowScene& scene, const Light& light) {
    const SoftShadowMap one = shadow_of(scene, light, sizes(96, 40));
    const SoftShadowMap two = shadow_of(scene, light, sizes(96, 40, ShadowPasses::two));
    EXPECT_EQ(two.statistics().micro_patches, 2 * one.statistics().micro_patches);
    const std::vector<double> truth = sampled(scene, light, receiver_points(one));
    return {error_of(receiver_points(one), truth), error_of(receiver_points(two), truth)};
}

// The closest faces of a thick occluder hide too little from a receiver aside (section 3.5).
TEST_F(SoftShadow, TwoPassesBeatOneForAThickOccluder) {
    const Light above = optics::aimed_light({0.0, 3.0, 0.0}, {0.0, 0.4, 0.0}, 0.6, 0.6);
    const Light aside = optics::aimed_light({1.5, 2.6, 0.4}, {0.0, 0.4, 0.0}, 0.6, 0.6);
    const ShadowScene round(ball({0.0, 0.8, 0.0}, 0.5, 4), floor_of_4);
    const ShadowScene edged(box({-0.3, 0.2, -0.3}, {0.3, 1.4, 0.3}), floor_of_4);
    for (const auto& [name, scene, light] :
         {std::tuple("ball, light above", &round, &above), std::tuple("ball, light aside", &round, &aside),
          std::tuple("box, light aside", &edged, &aside)}) {
        const OneAndTwo errors = errors_of_passes(*scene, *light);
        EXPECT_LT(errors.two.mean, 0.7 * errors.one.mean) << name << ": " << errors.two.worst;
        EXPECT_LT(errors.two.mean, 0.035) << name << ": " << errors.two.worst;
    }
}

// The documented limit: walls that the light sees at a grazing angle are patches at very different depths
// side by side, whose reprojections overlap (equation 3). Straight under the light the closest faces of a box
// are one lid, and the furthest are such walls: two passes then hide too much.
TEST_F(SoftShadow, SteepWallsHideTooMuch) {
    const ShadowScene scene(box({-0.3, 0.2, -0.3}, {0.3, 1.4, 0.3}), floor_of_4);
    const OneAndTwo errors = errors_of_passes(scene, light_above(3.0, 0.3, 0.3));
    EXPECT_LT(errors.one.mean, 0.006) << errors.one.worst;
    EXPECT_GT(errors.two.mean, 0.01) << errors.two.worst;
    EXPECT_LT(errors.two.mean, 0.03) << errors.two.worst;
}

// A sheet has one side: its second map is its first.
TEST_F(SoftShadow, TwoPassesOfASheetAreOnePass) {
    const ShadowScene scene(square({0.1, 1.0, -0.2}, 0.5, 0.4), floor_of_4);
    const Light light = light_above(3.0, 0.3, 0.3);
    EXPECT_EQ(shadow_of(scene, light, sizes(50, 40)).visible().values,
              shadow_of(scene, light, sizes(50, 40, ShadowPasses::two)).visible().values);
}

// Against rays, for a curved occluder: the error is a few percent, as in Atty et al. (figure 17).
TEST_F(SoftShadow, BallIsNearTheTruth) {
    const ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.5, 4), floor_of_4);
    const Light light = optics::aimed_light({0.5, 3.0, 0.3}, {0.0, 0.5, 0.0}, 0.6, 0.6);
    const SoftShadowMap map = shadow_of(scene, light, sizes(128, 48, ShadowPasses::two));
    const std::vector<ReceiverPoint> points = receiver_points(map);
    const ShadowError error = error_of(points, sampled(scene, light, points));
    EXPECT_LT(error.mean, 0.03) << error.worst;
    EXPECT_GT(error.shadowed, 500U);
}

/// The difference of a format from FP32 in the worst texel.
double deviation(const ShadowScene& scene, const Light& light, int size, ShadowFormat format,
                 std::uint64_t* batches = nullptr) {
    const SoftShadowMap exact = shadow_of(scene, light, sizes(size, 32));
    const SoftShadowMap map = shadow_of(scene, light, sizes(size, 32, ShadowPasses::one, format));
    if (batches != nullptr) *batches = map.statistics().batches;
    return error_of(receiver_points(map),
                    [&] {
                        std::vector<double> truth;
                        for (const ReceiverPoint& point : receiver_points(exact))
                            truth.push_back(point.visible);
                        return truth;
                    }())
        .greatest;
}

// Appendix A: a micro-patch must hide 2^-10 of the light, so be 1/32 of its width, or its share is lost. The
// square is 4 lights wide as seen from the floor: a patch is 1/32 of the light at 128 texels, 1/128 at 512.
TEST_F(SoftShadow, Fp16HoldsAt128AndBreaksAt512UnlessInBatches) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), floor_of_4);
    const Light light = light_above(2.0, 0.25, 0.25);
    std::uint64_t batches = 0;
    const double fp16_at_128 = deviation(scene, light, 128, ShadowFormat::fp16);
    const double fp16_at_512 = deviation(scene, light, 512, ShadowFormat::fp16);
    const double batches_at_512 = deviation(scene, light, 512, ShadowFormat::fp16_batches, &batches);
    RecordProperty("fp16_at_128", fmt::format("{:.4f}", fp16_at_128));
    RecordProperty("fp16_at_512", fmt::format("{:.4f}", fp16_at_512));
    RecordProperty("batches_at_512", fmt::format("{:.4f}", batches_at_512));
    EXPECT_LT(fp16_at_128, 0.01);
    EXPECT_GT(fp16_at_512, 0.3);
    EXPECT_LT(batches_at_512,
              0.04);  // 128 batches meet in a point; each rounds the sum, by up to 2^-11 of it
    EXPECT_EQ(batches, 512U);
}

TEST_F(SoftShadow, IsTheSameBitForBitEveryTime) {
    const ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.5, 4), floor_of_4);
    const Light light = light_above(3.0, 0.5, 0.5);
    const SoftShadowOptions options = sizes(100, 60, ShadowPasses::two, ShadowFormat::fp16_batches);
    const ShadowMesh occluders(scene.scene, scene.occluders);
    const ShadowMesh receivers(scene.scene, scene.receivers);
    const ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers);
    SoftShadowMap map(options);
    map.compute(light, frustum, occluders, receivers);
    const std::vector<float> first = map.visible().values;
    map.compute(light_above(2.5, 0.1, 0.9), frustum, receivers, occluders);  // leaves other values behind
    map.compute(light, frustum, occluders, receivers);
    EXPECT_EQ(first, map.visible().values);
}

// Contact: under the box the floor is dark, right beside it half dark or more, and no light leaks between.
TEST_F(SoftShadow, OccluderThatTouchesTheReceiverShadowsUpToTheContact) {
    const ShadowScene scene(box({-0.5, 0.0, -0.5}, {0.5, 0.5, 0.5}), floor_of_4);
    const Light light = light_above(3.0, 0.3, 0.3);
    const SoftShadowMap map = shadow_of(scene, light, sizes(128, 64, ShadowPasses::two));
    int under = 0;
    for (const ReceiverPoint& point : receiver_points(map)) {
        if (std::max(std::abs(point.position.x), std::abs(point.position.y)) > 0.49) continue;
        EXPECT_NEAR(point.visible, 0.0, 0.02) << "texel (" << point.x << ", " << point.y << ")";
        ++under;
    }
    EXPECT_GT(under, 500);
}

// A million units from the world's origin floats hold 1/16 of a unit: all sums of places are in double.
TEST_F(SoftShadow, FarFromTheOriginIsAsNear) {
    ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.5, 3), floor_of_4);
    Light light = light_above(3.0, 0.3, 0.2);
    const ShadowFrustum frustum = {0.01, {dvec2(-0.3), dvec2(0.3)}, {dvec2(-0.4), dvec2(0.4)}};
    const std::vector<float> near = shadow_of(scene, light, sizes(50, 40), frustum).visible().values;
    const dvec3 away(1e6, -2e6, 3e6);
    for (scenes::Node& node : scene.scene.nodes)
        node.trs.translation = away;
    scene.whole = scenes::take_snapshot(scene.scene);
    scene.occluders = scenes::part_of(scene.whole, {false, true});
    scene.receivers = scenes::part_of(scene.whole, {true, false});
    light.position += away;
    const std::vector<float> far = shadow_of(scene, light, sizes(50, 40), frustum).visible().values;
    double greatest = 0.0;
    for (std::size_t i = 0; i < near.size(); ++i)
        greatest = std::max(greatest, double(std::abs(near[i] - far[i])));
    EXPECT_LT(greatest, 0.01);
}

// The times of the first map of a context, too, before which the driver has drawn nothing.
TEST_F(SoftShadow, TellsItsTime) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), floor_of_4);
    const Clock::time_point start = Clock::now();
    const renderer::SoftShadowStatistics statistics =
        shadow_of(scene, light_above(3.0, 0.3, 0.3), sizes(64, 128)).statistics();
    EXPECT_GT(statistics.hide_ms, 0.0);
    EXPECT_LT(statistics.milliseconds, milliseconds_since(start));
    EXPECT_LE(statistics.maps_ms + statistics.patches_ms + statistics.hide_ms, statistics.milliseconds);
}

TEST_F(SoftShadow, WithoutOccludersAllIsLit) {
    const ShadowScene scene({}, floor_of_4);
    const SoftShadowMap map = shadow_of(scene, light_above(3.0, 0.3, 0.3), sizes(32, 32, ShadowPasses::two));
    EXPECT_EQ(map.statistics().micro_patches, 0U);
    for (const float value : map.visible().values)
        EXPECT_EQ(value, 1.0F);
}

TEST_F(SoftShadow, WithoutReceiversAllIsLit) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), {});
    const SoftShadowMap map = shadow_of(scene, light_above(3.0, 0.3, 0.3), sizes(32, 32, ShadowPasses::two));
    EXPECT_EQ(map.statistics().fragments, 0U);
    for (const float value : map.visible().values)
        EXPECT_EQ(value, 1.0F);
}

TEST_F(SoftShadow, OccludersBehindTheLightOrTheReceiverHideNothing) {
    for (const double height : {3.5, -0.5}) {
        const ShadowScene scene(square({0.0, height, 0.0}, 0.5), floor_of_4);
        const SoftShadowMap map =
            shadow_of(scene, light_above(3.0, 0.3, 0.3), sizes(32, 32, ShadowPasses::two));
        for (const float value : map.visible().values)
            ASSERT_EQ(value, 1.0F) << "occluder at " << height;
    }
}

// The documented limit: the part of a post that reaches through the light's plane is cut at the near
// distance, and the rest shadows as a post that ends there would.
TEST_F(SoftShadow, OccluderThroughTheLightIsCutAtTheNearDistance) {
    const Light light = light_above(3.0, 0.3, 0.3);
    const auto near_2 = [&](const ShadowScene& scene) {
        ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers, 2.0);
        frustum.occluders = {dvec2(-0.25), dvec2(0.25)};
        frustum.receivers = {dvec2(-0.6), dvec2(0.6)};
        return shadow_of(scene, light, sizes(64, 48, ShadowPasses::two), frustum);
    };
    // Open at the top: a lid would be a face that the cut one does not have.
    const auto post = [](double top) {
        return Corners(quad({-0.2, 0, -0.2}, {-0.2, 0, 0.2}, {-0.2, top, 0.2}, {-0.2, top, -0.2}));
    };
    const SoftShadowMap through = near_2({post(3.5), floor_of_4});
    const SoftShadowMap cut = near_2({post(1.0), floor_of_4});
    const std::vector<float> a = through.visible().values;
    const std::vector<float> b = cut.visible().values;
    EXPECT_GT(through.statistics().micro_patches, 0U);
    double greatest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        greatest = std::max(greatest, double(std::abs(a[i] - b[i])));
    EXPECT_LT(greatest, 0.05);
    for (const interop::MicroPatch& patch : through.micro_patches(0))
        EXPECT_LE(patch.inverse_depth, 0.5F * 1.0001F);
}

// A light low over the floor, looking along it: depths within one texel differ by far. The map agrees with
// rays.
TEST_F(SoftShadow, GrazingLight) {
    const ShadowScene scene(box({-0.2, 0.0, -0.2}, {0.2, 0.6, 0.2}), floor_of_4);
    const Light light = optics::aimed_light({3.0, 0.5, 0.2}, {0.0, 0.1, 0.0}, 0.2, 0.2);
    const SoftShadowMap map = shadow_of(scene, light, sizes(128, 48, ShadowPasses::two));
    const std::vector<ReceiverPoint> points = receiver_points(map);
    const ShadowError error = error_of(points, sampled(scene, light, points));
    EXPECT_LT(error.mean, 0.05) << error.worst;
    EXPECT_GT(error.shadowed, 200U);
}

TEST_F(SoftShadow, RefusesWhatIsNoLightNoMapAndNoFrustum) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), floor_of_4);
    const Light light = light_above(3.0, 0.3, 0.3);
    const auto fault_of = [](const auto& call) {
        try {
            call();
        } catch (const Error& error) {
            return error.fault() == Fault::usage ? std::string("usage") : std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(fault_of([] { SoftShadowMap({.occluder_size = 0}); }), "usage");
    EXPECT_EQ(fault_of([] { SoftShadowMap({.receiver_size = 2049}); }), "usage");
    EXPECT_EQ(fault_of([&] { (void)shadow_of(scene, light_above(3.0, 0.0, 0.3), {}); }), "usage");
    Light skewed = light;
    skewed.half_v = {0.1, 0.0, 0.3};
    EXPECT_EQ(fault_of([&] { (void)shadow_of(scene, skewed, {}); }), "usage");
    ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers);
    frustum.near_distance = 0.0;
    EXPECT_EQ(fault_of([&] { (void)shadow_of(scene, light, {}, frustum); }), "usage");
    frustum = {0.1, {dvec2(1.0), dvec2(1.0)}, {}};
    EXPECT_EQ(fault_of([&] { (void)shadow_of(scene, light, {}, frustum); }), "usage");
}

}  // namespace
}  // namespace cairn::test
