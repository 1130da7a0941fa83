#include "optics/light.h"

#include <functional>

#include <gtest/gtest.h>

#include "base/error.h"

namespace cairn::optics {
namespace {

using glm::dvec3;

void expect_near(const dvec3& found, const dvec3& expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-12)
        << found.x << ", " << found.y << ", " << found.z << " instead of " << expected.x << ", " << expected.y
        << ", " << expected.z;
}

dvec3 in_light_space(const Light& light, const dvec3& point) {
    return dvec3(light_from_world(light) * glm::dvec4(point, 1.0));
}

bool is_refused(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.fault() == Fault::usage;
    }
    return false;
}

TEST(Light, AimedFacesItsTargetWithTwoLevelEdges) {
    const Light light = aimed_light({1.0, 3.0, 2.0}, {0.0, 0.5, -1.0}, 0.8, 0.4);
    EXPECT_TRUE(light.positional);
    EXPECT_EQ(light.shape, LightShape::rectangle);
    EXPECT_EQ(light.position, dvec3(1.0, 3.0, 2.0));
    EXPECT_NEAR(half_size(light).x, 0.4, 1e-12);
    EXPECT_NEAR(half_size(light).y, 0.2, 1e-12);
    EXPECT_NEAR(light.half_u.y, 0.0, 1e-12) << "level";
    EXPECT_NEAR(glm::dot(light.half_u, light.half_v), 0.0, 1e-12);
    expect_near(glm::normalize(glm::cross(light.half_u, light.half_v)),
                glm::normalize(dvec3(-1.0, -2.5, -3.0)));
}

TEST(Light, AimedStraightDownHasAnAxisAlongX) {
    const Light light = aimed_light({0.0, 2.0, 0.0}, {0.0, 0.0, 0.0}, 2.0, 1.0);
    EXPECT_EQ(light.half_u.y, 0.0);
    expect_near(glm::normalize(glm::cross(light.half_u, light.half_v)), {0.0, -1.0, 0.0});
}

TEST(Light, SpaceHasItsMiddleAtTheOriginAndItsHalfAxesAlongXAndY) {
    const Light light = aimed_light({1.0, 3.0, 2.0}, {0.0, 0.5, -1.0}, 0.8, 0.4);
    expect_near(in_light_space(light, light.position), {0.0, 0.0, 0.0});
    expect_near(in_light_space(light, light.position + light.half_u), {0.4, 0.0, 0.0});
    expect_near(in_light_space(light, light.position + light.half_v), {0.0, 0.2, 0.0});
    expect_near(in_light_space(light, {0.0, 0.5, -1.0}), {0.0, 0.0, glm::length(dvec3(1.0, 2.5, 3.0))});
}

TEST(Light, OnlyARectangleWithAnAreaHasASpace) {
    const Light light = aimed_light({0.0, 3.0, 0.0}, {0.0, 0.0, 0.0}, 0.8, 0.4);
    const auto changed = [&](const std::function<void(Light&)>& change) {
        Light other = light;
        change(other);
        return is_refused([&] { (void)light_from_world(other); });
    };
    EXPECT_FALSE(changed([](Light&) {}));
    EXPECT_TRUE(changed([](Light& l) { l.shape = LightShape::disk; }));
    EXPECT_TRUE(changed([](Light& l) { l.shape = LightShape::sphere; }));
    EXPECT_TRUE(changed([](Light& l) { l.positional = false; }));
    EXPECT_TRUE(changed([](Light& l) { l.half_u = dvec3(0.0); }));
    EXPECT_TRUE(changed([](Light& l) { l.half_v += 0.5 * l.half_u; })) << "skewed";
    EXPECT_TRUE(is_refused([] { (void)half_size(Light{}); }));
    EXPECT_TRUE(is_refused([] { (void)aimed_light({0, 1, 0}, {0, 1, 0}, 1.0, 1.0); }));
    EXPECT_TRUE(is_refused([] { (void)aimed_light({0, 1, 0}, {0, 0, 0}, 0.0, 1.0); }));
}

}  // namespace
}  // namespace cairn::optics
