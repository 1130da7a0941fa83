#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/shadow_truth.h"
#include "tests/support/soft_shadow_scene.h"

namespace cairn::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using optics::Light;
using optics::LightShape;
using test::light_above;
using test::ShadowScene;
using test::square;

constexpr AreaLightOptions fine = {.standard_error = 0.002, .most_samples = 1 << 18};

LightVisibility seen_from(const ShadowScene& scene, const dvec3& point, const Light& light,
                          const dvec3& normal = dvec3(0.0), const AreaLightOptions& options = fine) {
    const ImageTracer tracer(scene.scene, scene.occluders);
    return area_light_visibility(tracer, {&point, 1}, {&normal, 1}, light, options)[0];
}

void expect_visible(const LightVisibility& found, double truth) {
    EXPECT_LT(found.standard_error, fine.standard_error);
    EXPECT_NEAR(found.visible, truth, 4.0 * fine.standard_error) << found.samples << " samples";
}

TEST(AreaLight, RectanglePastASquareIsTheClosedForm) {
    const ShadowScene scene(square({0.1, 1.0, -0.2}, 0.5), square({0, 0, 0}, 2.0));
    const Light light = light_above(3.0, 0.4, 0.25);
    const std::vector<dvec2> polygon = {{-0.4, -0.7}, {0.6, -0.7}, {0.6, 0.3}, {-0.4, 0.3}};
    for (const double x : {-1.5, -0.9, -0.7, 0.0, 0.8, 1.0}) {
        const double truth = test::visible_past(polygon, 2.0, {x, 0.3, 3.0}, {0.4, 0.25});
        expect_visible(seen_from(scene, {x, 0.0, 0.3}, light), truth);
    }
}

// The edge of a wide sheet cuts a segment off the disk.
TEST(AreaLight, DiskPastAnEdgeIsACircularSegment) {
    const ShadowScene scene(square({10.0, 1.0, 0.0}, 10.0), square({0, 0, 0}, 2.0));
    Light light = light_above(2.0, 0.5, 0.5);
    light.shape = LightShape::disk;
    for (const double x : {-0.4, -0.2, 0.0, 0.3}) {
        // From (x, 0, 0) past x = 0 at half the way, the part of the light's plane below -x is seen.
        const double h = -x / 0.5;
        const double truth = 1.0 - (std::acos(h) - h * std::sqrt(1.0 - h * h)) / std::numbers::pi;
        expect_visible(seen_from(scene, {x, 0.0, 0.0}, light), truth);
    }
}

/// The share of the solid angle of a cone of directions from (x, 0, 0) that passes x < 0 at height 1, summed
/// over a grid of directions.
double share_past_the_edge(double x, const dvec3& axis, double sine) {
    double all = 0.0;
    double seen = 0.0;
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i) {
        const double height = (i + 0.5) / steps;
        for (int k = 0; k < steps; ++k) {
            const double angle = 2.0 * std::numbers::pi * (k + 0.5) / steps;
            const double across = std::sqrt(1.0 - height * height);
            const dvec3 way(across * std::cos(angle), height, across * std::sin(angle));
            if (glm::dot(way, axis) < std::sqrt(1.0 - sine * sine)) continue;
            ++all;
            if (x + way.x / way.y < 0.0) ++seen;
        }
    }
    return seen / all;
}

TEST(AreaLight, SphereIsMeasuredInSolidAngle) {
    const ShadowScene scene(square({10.0, 1.0, 0.0}, 10.0), square({0, 0, 0}, 2.0));
    const Light light = {.positional = true, .position = {0, 2, 0}, .radius = 0.9};
    for (const double x : {-0.5, 0.0, 0.25}) {
        const dvec3 way = light.position - dvec3(x, 0.0, 0.0);
        const double truth = share_past_the_edge(x, glm::normalize(way), light.radius / glm::length(way));
        expect_visible(seen_from(scene, {x, 0.0, 0.0}, light), truth);
    }
}

// A directional light with an angle is like a sphere far away: from everywhere in the scene it has the same
// direction and the same angle.
TEST(AreaLight, DirectionalLightIsAConeOfItsAngle) {
    const ShadowScene scene(square({10.0, 1.0, 0.0}, 10.0), square({0, 0, 0}, 2.0));
    const Light light = {.towards = {0.5, 2.0, 0.0}, .angle = 0.4};
    for (const double x : {-0.5, -0.25, 0.0}) {
        const double truth = share_past_the_edge(x, glm::normalize(light.towards), std::sin(light.angle));
        expect_visible(seen_from(scene, {x, 0.0, 0.0}, light), truth);
    }
}

TEST(AreaLight, BelowTheTangentPlaneNothingIsSeen) {
    const ShadowScene scene(square({0, -5, 0}, 0.1), square({0, 0, 0}, 2.0));
    for (const LightShape shape : {LightShape::rectangle, LightShape::disk, LightShape::sphere}) {
        Light light = light_above(2.0, 0.5, 0.5);
        light.shape = shape;
        light.radius = 0.1;
        expect_visible(seen_from(scene, {0, 0, 0}, light, {1, 0, 0}), 0.5);
        expect_visible(seen_from(scene, {0, 0, 0}, light, {0, -1, 0}), 0.0);
        expect_visible(seen_from(scene, {0, 0, 0}, light, {0, 1, 0}), 1.0);
    }
}

// The standard error is right: over many points, the truth lies as far away as it says.
TEST(AreaLight, StandardErrorTellsTheSpread) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5, 0.3), square({0, 0, 0}, 2.0));
    const Light light = light_above(2.0, 0.4, 0.4);
    const ImageTracer tracer(scene.scene, scene.occluders);
    std::vector<dvec2> polygon;
    const test::Corners corners = square({0.0, 1.0, 0.0}, 0.5, 0.3);
    for (const std::size_t i : {0U, 1U, 2U, 5U})
        polygon.emplace_back(corners[i].x, corners[i].z);
    std::vector<dvec3> points;
    for (int i = 0; i < 400; ++i)
        points.emplace_back(0.6 + 0.8 * (i % 20) / 20.0, 0.0, -0.8 + 1.6 * (i / 20) / 20.0);
    const auto found = area_light_visibility(tracer, points, {}, light, {.standard_error = 0.01});
    int partly = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double truth = test::visible_past(polygon, 1.0, {points[i].x, points[i].z, 2.0}, {0.4, 0.4});
        if (found[i].standard_error == 0.0) continue;
        ++partly;
        squares += std::pow((found[i].visible - truth) / found[i].standard_error, 2);
    }
    ASSERT_GT(partly, 100);
    // 1 for an exact estimate of the spread; few rounds estimate it loosely, and those that guess low stop.
    EXPECT_LT(squares / partly, 4.0);
    EXPECT_GT(squares / partly, 0.3);
}

TEST(AreaLight, DoesNotDependOnTheThreads) {
    const ShadowScene scene(test::ball({0.0, 1.0, 0.0}, 0.5, 2), square({0, 0, 0}, 2.0));
    const Light light = light_above(3.0, 0.4, 0.4);
    const ImageTracer tracer(scene.scene, scene.occluders);
    std::vector<dvec3> points;
    for (int i = 0; i < 50; ++i)
        points.emplace_back(-1.0 + 0.04 * i, 0.0, 0.1);
    AreaLightOptions options;
    options.threads = 1;
    const auto alone = area_light_visibility(tracer, points, {}, light, options);
    options.threads = 2;
    const auto together = area_light_visibility(tracer, points, {}, light, options);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(alone[i].visible, together[i].visible) << "point " << i;
}

// Exact numbers of samples, as a peer of shadow rays: their error against the closed form falls with their
// number, and packets find the same as single rays.
TEST(AreaLight, ExactStrataTakeThatManySamples) {
    const ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), square({0, 0, 0}, 2.0));
    const Light light = light_above(2.0, 0.4, 0.4);
    const ImageTracer tracer(scene.scene, scene.occluders);
    const std::vector<dvec2> polygon = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    std::vector<dvec3> points;
    for (int i = 0; i < 400; ++i)
        points.emplace_back(0.6 + 0.8 * (i % 20) / 20.0, 0.0, -0.8 + 1.6 * (i / 20) / 20.0);
    double before = 1.0;
    for (const int strata : {1, 2, 3, 4, 8, 16}) {
        AreaLightOptions options;
        options.exact_strata = strata;
        const auto found = area_light_visibility(tracer, points, {}, light, options);
        options.rays = ImageTracer::Rays::packets;
        const auto packets = area_light_visibility(tracer, points, {}, light, options);
        double squares = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double truth =
                test::visible_past(polygon, 1.0, {points[i].x, points[i].z, 2.0}, {0.4, 0.4});
            EXPECT_EQ(found[i].samples, strata * strata);
            EXPECT_EQ(found[i].visible, packets[i].visible) << "point " << i << ", strata " << strata;
            squares += std::pow(found[i].visible - truth, 2);
        }
        const double rmse = std::sqrt(squares / double(points.size()));
        EXPECT_LT(rmse, before) << strata << " strata";
        EXPECT_LE(rmse, 0.5 / strata);
        before = 0.75 * rmse;
    }
}

TEST(AreaLight, RefusesWhatIsNoLight) {
    const ShadowScene scene(square({0, 1, 0}, 0.1), square({0, 0, 0}, 2.0));
    const auto refused = [&](const Light& light, const AreaLightOptions& options = {}) {
        try {
            (void)seen_from(scene, {0, 0, 0}, light, dvec3(0.0), options);
        } catch (const Error& error) {
            return error.fault() == Fault::usage;
        }
        return false;
    };
    const Light light = light_above(1.0, 0.1, 0.1);
    EXPECT_TRUE(refused(light_above(1.0, 0.0, 0.1)));
    EXPECT_TRUE(refused({.positional = true, .position = {0, 1, 0}, .radius = 0.0}));
    EXPECT_TRUE(refused({.positional = true, .position = {0, 0.1, 0}, .radius = 0.2}));
    EXPECT_TRUE(refused({.positional = false, .angle = 0.0}));
    EXPECT_TRUE(refused(light, {.standard_error = 0.0}));
    EXPECT_TRUE(refused(light, {.exact_strata = -1}));
    EXPECT_TRUE(refused(light, {.exact_strata = 257}));
    EXPECT_FALSE(refused(light));
    EXPECT_FALSE(refused({.positional = false, .angle = 0.1}));
}

}  // namespace
}  // namespace cairn::reference
