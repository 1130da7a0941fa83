// Cases in which soft shadow maps fail, or might, besides those of
// tests/renderer/shadow/soft_shadow_map_test.cpp (a tiny light, contact of a box, an occluder through the
// light, FP16, walls of a box). Each test asserts what soft_shadow_map.h and optics/light.h say about its
// case.

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "reference/image.h"
#include "reference/shadow_truth.h"
#include "renderer/shadow/map_shadows.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/soft_shadow_scene.h"

namespace cairn::test {
namespace {

using glm::dvec2;
using glm::dvec3;
using optics::Light;
using renderer::fit_shadow_frustum;
using renderer::ShadowFrustum;
using renderer::ShadowPasses;
using renderer::SoftShadowMap;
using renderer::SoftShadowOptions;

class SoftShadowLimits : public GlTest {};

const Corners floor_of_4 = square({0.0, 0.0, 0.0}, 2.0);

SoftShadowOptions sizes(int occluder_size, int receiver_size) {
    return {occluder_size, receiver_size, ShadowPasses::two, renderer::ShadowFormat::fp32};
}

renderer::ShadowScene thing_over_floor(const ShadowScene& scene) {
    return {scene.scene, scene.whole, scenes::NodeSelection{false, true}, scenes::NodeSelection{true, false}};
}

std::vector<double> rays_find(const ShadowScene& scene, const Light& light,
                              const std::vector<dvec3>& points) {
    const reference::ImageTracer tracer(scene.scene, scene.occluders);
    std::vector<double> seen;
    for (const reference::LightVisibility& there : reference::area_light_visibility(
             tracer, points, {}, light, {.standard_error = 0.006, .most_samples = 2048}))
        seen.push_back(there.visible);
    return seen;
}

std::vector<double> rays_find(const ShadowScene& scene, const SoftShadowMap& map) {
    const glm::dmat4 world_from_light = glm::inverse(optics::light_from_world(map.light()));
    std::vector<dvec3> points;
    for (const ReceiverPoint& point : receiver_points(map))
        points.emplace_back(world_from_light * glm::dvec4(point.position, 1.0));
    return rays_find(scene, map.light(), points);
}

/// An upright sheet through the light's axis.
Corners upright(double half_thickness) {
    Corners one = quad({half_thickness, 0.3, -0.6}, {half_thickness, 0.3, 0.6}, {half_thickness, 1.3, 0.6},
                       {half_thickness, 1.3, -0.6});
    if (half_thickness == 0.0) return one;
    return box({-half_thickness, 0.3, -0.6}, {half_thickness, 1.3, 0.6});
}

// The documented limit: a sheet that the light's centre sees edge-on hides nothing, although rays find a
// shadow. As thick as some texels, it is found.
TEST_F(SoftShadowLimits, ASheetSeenEdgeOnHidesNothing) {
    const Light light = light_above(3.0, 0.5, 0.5);
    const ShadowFrustum frustum = {0.01, {dvec2(-0.5), dvec2(0.5)}, {dvec2(-0.5), dvec2(0.5)}};
    const ShadowScene thin(upright(0.0), floor_of_4);
    const SoftShadowMap map = shadow_of(thin, light, sizes(128, 48), frustum);
    EXPECT_EQ(map.statistics().micro_patches, 0U);
    for (const float value : map.visible().values)
        ASSERT_EQ(value, 1.0F);
    const std::vector<double> truth = rays_find(thin, map);
    EXPECT_LT(*std::min_element(truth.begin(), truth.end()), 0.7) << "there is no shadow to miss";

    const ShadowScene thick(upright(0.03), floor_of_4);
    const SoftShadowMap found = shadow_of(thick, light, sizes(256, 48), frustum);
    const ShadowError error = error_of(receiver_points(found), rays_find(thick, found));
    EXPECT_LT(error.mean, 0.09) << error.worst;
    const std::vector<float> visible = found.visible().values;
    EXPECT_LT(*std::min_element(visible.begin(), visible.end()), 0.7F);
}

// A sheet without thickness that faces the light hides all of it from points straight under the sheet.
TEST_F(SoftShadowLimits, AThinSheetLetsNoLightThrough) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.8, 0.3), floor_of_4);
    const SoftShadowMap map = shadow_of(scene, light_above(3.0, 0.2, 0.2), sizes(100, 64));
    int under = 0;
    for (const ReceiverPoint& point : receiver_points(map)) {
        if (glm::length(dvec2(point.position)) > 0.8) continue;
        EXPECT_LT(point.visible, 1e-4) << "texel (" << point.x << ", " << point.y << ")";
        ++under;
    }
    EXPECT_GT(under, 300);
}

// A light between two sheets: the sheet behind it changes nothing, bit for bit.
TEST_F(SoftShadowLimits, LightAmongTheOccluders) {
    const Corners below = square({0.1, 1.0, -0.1}, 0.4, 0.2);
    Corners both = below;
    const Corners above = square({0.0, 2.1, 0.0}, 0.7);
    both.insert(both.end(), above.begin(), above.end());
    const Light light = light_above(2.0, 0.3, 0.3);
    const ShadowScene all(both, floor_of_4);
    const ShadowScene one(below, floor_of_4);
    const ShadowFrustum frustum = fit_shadow_frustum(light, one.occluders, one.receivers);
    const SoftShadowMap map = shadow_of(all, light, sizes(96, 64), frustum);
    EXPECT_EQ(map.visible().values, shadow_of(one, light, sizes(96, 64), frustum).visible().values);
    const ShadowError error = error_of(receiver_points(map), rays_find(one, map));
    EXPECT_LT(error.mean, 0.02) << error.worst;
    const ShadowFrustum fitted = fit_shadow_frustum(light, all.occluders, all.receivers);
    EXPECT_EQ(fitted.occluders, frustum.occluders) << "the window is that of what lies before the light";
}

// The documented limit: an occluder nearer to the light's plane than the near distance hides nothing, one
// that is a little further hides all.
TEST_F(SoftShadowLimits, AnOccluderAtTheLightIsCutAtTheNearDistance) {
    const double near_distance = 0.02;
    for (const double off : {0.5, 0.9, 1.1, 2.0}) {
        const Light light = light_above(3.0, 0.1, 0.1);
        const ShadowScene scene(square({0.0, 3.0 - off * near_distance, 0.0}, 0.15), floor_of_4);
        ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers, near_distance);
        const SoftShadowMap map = shadow_of(scene, light, sizes(64, 48), frustum);
        for (const ReceiverPoint& point : receiver_points(map)) {
            if (glm::length(dvec2(point.position)) > 1.0) continue;
            ASSERT_NEAR(point.visible, off < 1.0 ? 1.0 : 0.0, 2e-3) << off << " near distances off";
        }
    }
}

// The documented limit: an occluder in the plane of the receiver hides nothing; slightly above, it hides all.
TEST_F(SoftShadowLimits, AnOccluderInTheReceiversPlaneHidesNothing) {
    const Light light = light_above(3.0, 0.2, 0.2);
    for (const double lift : {0.0, 1e-3, 1e-2}) {
        const ShadowScene scene(square({0.0, lift, 0.0}, 0.5), floor_of_4);
        const SoftShadowMap map = shadow_of(scene, light, sizes(64, 64));
        int under = 0;
        for (const ReceiverPoint& point : receiver_points(map)) {
            if (std::max(std::abs(point.position.x), std::abs(point.position.y)) > 0.45) continue;
            ASSERT_NEAR(point.visible, lift == 0.0 ? 1.0 : 0.0, 1e-3) << "lift " << lift;
            ++under;
        }
        EXPECT_GT(under, 1000);
    }
}

// The documented limit: receivers behind the light, or further aside than max_shadow_tangent, have no texel
// and count as lit. The rest is near the truth, however low the light.
TEST_F(SoftShadowLimits, LightThatGrazesTheFloor) {
    const ShadowScene scene(box({-0.2, 0.0, -0.2}, {0.2, 0.5, 0.2}), square({0.0, 0.0, 0.0}, 6.0));
    // The light looks along the floor: half of the floor lies behind it.
    const Light light = optics::aimed_light({2.0, 0.3, 0.1}, {0.0, 0.3, 0.1}, 0.2, 0.2);
    const ShadowFrustum frustum = fit_shadow_frustum(light, scene.occluders, scene.receivers);
    EXPECT_LE(std::max(std::abs(frustum.receivers.low.y), std::abs(frustum.receivers.high.y)),
              renderer::max_shadow_tangent);
    const SoftShadowMap map = shadow_of(scene, light, sizes(128, 64), frustum);
    const std::vector<ReceiverPoint> points = receiver_points(map);
    for (const ReceiverPoint& point : points)
        ASSERT_GT(point.position.z, 0.0);
    const ShadowError error = error_of(points, rays_find(scene, map));
    EXPECT_LT(error.mean, 0.06) << error.worst;
    EXPECT_GT(error.shadowed, 500U);

    renderer::MapShadows pictures(thing_over_floor(scene));
    renderer::View view;
    view.size = {96, 96};
    view.shadow.kind = renderer::ShadowQuality::Kind::rays;
    view.camera = {.eye = {0.0, 12.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 0.9};
    view.light = light;
    const renderer::ShadowPicture picture = pictures.render(view);
    int behind = 0;
    for (int y = 0; y < 96; ++y) {
        for (int x = 60; x < 96; ++x) {  // x > 2.6
            const float visible = picture.light.shares[std::size_t(y) * 96 + std::size_t(x)];
            if (visible < 0.0F) continue;
            ASSERT_EQ(visible, 1.0F) << "pixel (" << x << ", " << y << ")";
            ++behind;
        }
    }
    EXPECT_GT(behind, 1000);
}

/// A view from under the ball, in which the floor is the furthest thing.
renderer::View from_under_the_ball() {
    renderer::View view;
    view.size = {80, 80};
    view.shadow.kind = renderer::ShadowQuality::Kind::rays;
    view.camera = {.eye = {0.0, 0.1, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 2.9};
    return view;
}

// Depths are floats, and if the eye is among the things the near plane is very near: the furthest thing must
// not be rounded past the far plane.
TEST_F(SoftShadowLimits, AnEyeAmongTheOccludersSeesTheFurthestReceiver) {
    const ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.4, 2), floor_of_4);
    renderer::MapShadows pictures(thing_over_floor(scene));
    renderer::View view = from_under_the_ball();
    view.light = light_above(3.0, 0.2, 0.2);
    for (const float visible : pictures.render(view).light.shares)
        ASSERT_GE(visible, 0.0F) << "the floor is not there";
}

// One map has one light; two lights are the sum of two maps.
TEST_F(SoftShadowLimits, MoreThanOneLight) {
    const ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.4, 4), floor_of_4);
    renderer::View view = from_under_the_ball();
    const std::array<Light, 2> lights = {optics::aimed_light({1.2, 3.0, 0.3}, {0.0, 0.5, 0.0}, 0.4, 0.4),
                                         optics::aimed_light({-0.9, 2.5, -0.8}, {0.0, 0.5, 0.0}, 0.6, 0.3)};
    renderer::MapShadows pictures(thing_over_floor(scene));
    std::vector<double> sum, truth;
    for (const Light& light : lights) {
        view.light = light;
        const renderer::ShadowPicture picture = pictures.render(view);
        std::vector<dvec3> points;
        const double half = std::tan(0.5 * view.camera.yfov);
        for (int y = 0; y < view.size.height; ++y) {
            for (int x = 0; x < view.size.width; ++x)
                points.emplace_back(0.1 * half * ((2.0 * x + 1.0) / view.size.width - 1.0), 0.0,
                                    0.1 * half * ((2.0 * y + 1.0) / view.size.height - 1.0));
        }
        const std::vector<double> seen = rays_find(scene, light, points);
        sum.resize(points.size());
        truth.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_GE(picture.light.shares[i], 0.0F) << "pixel " << i << " is no floor";
            sum[i] += picture.light.shares[i];
            truth[i] += seen[i];
        }
    }
    double apart = 0.0;
    int shadowed = 0;
    int twice = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        if (truth[i] >= 2.0 && sum[i] >= 2.0) continue;
        apart += std::abs(sum[i] - truth[i]);
        ++shadowed;
        twice += truth[i] < 0.95 ? 1 : 0;
    }
    EXPECT_GT(shadowed, 400);
    EXPECT_GT(twice, 20) << "nowhere do both shadows fall";
    EXPECT_LT(apart / shadowed, 0.04);
}

}  // namespace
}  // namespace cairn::test
