// The shadow map with percentage-closer filtering that the charts compare with, against closed forms.
#include "bench/peers/pcf_shadow.h"

#include <cmath>

#include "base/error.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/soft_shadow_scene.h"

namespace cairn::bench {
namespace {

using glm::dvec2;
using glm::dvec3;
using test::ShadowScene;
using test::square;

/// Points of a floor at y = 0, in a row along x.
struct FloorRow {
    std::vector<dvec3> points, normals;

    FloorRow(double low, double high, double z, int count = 201) {
        for (int i = 0; i < count; ++i)
            points.emplace_back(glm::mix(low, high, double(i) / (count - 1)), 0.0, z);
        normals.assign(points.size(), {0, 1, 0});
    }
};

optics::Light rectangle_above(double height, double half) {
    optics::Light light;
    light.positional = true;
    light.position = {0, height, 0};
    light.shape = optics::LightShape::rectangle;
    light.half_u = {half, 0, 0};
    light.half_v = {0, 0, half};
    return light;
}

class PcfShadowTest : public test::GlTest {
protected:
    static std::vector<float> shadow(const ShadowScene& scene, const optics::Light& light,
                                     const FloorRow& row, const PcfOptions& options) {
        PcfShadow map(scene.scene, scene.whole, scene.occluders, light, row.points, row.normals);
        const PcfShadow::Result result = map.shadow(options);
        EXPECT_GT(result.milliseconds, 0.0);
        EXPECT_EQ(result.shares.size(), row.points.size());
        return result.shares;
    }
};

// A square of +-0.5 at half the height casts a shadow of +-1 on the floor.
TEST_F(PcfShadowTest, PositionalLightEnlargesASquare) {
    const ShadowScene scene(square({0, 1, 0}, 0.5), square({0, 0, 0}, 3.0));
    const FloorRow row(-2.0, 2.0, 0.3);
    for (const int kernel : {1, 3, 5}) {
        const auto shares =
            shadow(scene, rectangle_above(2.0, 0.1), row, {.map_size = 512, .kernel = kernel});
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const double from_edge = std::abs(row.points[i].x) - 1.0;
            // Texels are 2 / 512 wide on the floor. The filter reaches half a kernel and half a texel.
            if (std::abs(from_edge) < (0.5 * kernel + 1.5) * 2.04 / 512) continue;
            EXPECT_EQ(shares[i], from_edge < 0.0 ? 0.0F : 1.0F)
                << "x = " << row.points[i].x << ", kernel " << kernel;
        }
    }
}

// Under a light at infinity the shadow keeps its size and is moved by the slope times the height.
TEST_F(PcfShadowTest, DirectionalLightMovesASquare) {
    const ShadowScene scene(square({0, 1, 0}, 0.5), square({0, 0, 0}, 3.0));
    optics::Light light;
    light.towards = {-0.75, 1.0, 0.0};
    const FloorRow row(-2.0, 2.0, 0.2);
    const auto shares = shadow(scene, light, row, {.map_size = 512, .kernel = 3});
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double from_edge = std::abs(row.points[i].x - 0.75) - 0.5;
        if (std::abs(from_edge) < 0.02) continue;
        EXPECT_EQ(shares[i], from_edge < 0.0 ? 0.0F : 1.0F) << "x = " << row.points[i].x;
    }
}

// The estimate of the penumbra is made for one blocker parallel to the receiver.
TEST_F(PcfShadowTest, PenumbraOfASquareIsNearTheClosedForm) {
    const ShadowScene scene(square({0, 1, 0}, 0.5), square({0, 0, 0}, 3.0));
    const FloorRow row(-1.8, 1.8, 0.0);
    const std::vector<dvec2> polygon = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    const auto rmse = [&](const PcfOptions& options) {
        const auto shares = shadow(scene, rectangle_above(2.0, 0.3), row, options);
        double squares = 0.0;
        for (std::size_t i = 0; i < shares.size(); ++i) {
            const double truth =
                test::visible_past(polygon, 1.0, {row.points[i].x, row.points[i].z, 2.0}, {0.3, 0.3});
            squares += std::pow(double(shares[i]) - truth, 2);
        }
        return std::sqrt(squares / double(shares.size()));
    };
    const double soft = rmse({.map_size = 512, .filter = PcfFilter::penumbra, .kernel = 16});
    EXPECT_LT(soft, 0.03);
    EXPECT_GT(rmse({.map_size = 512, .filter = PcfFilter::fixed, .kernel = 3}), 3.0 * soft);
}

// A wide filter does not shadow the receiver with itself, because it compares with the receiver's plane.
TEST_F(PcfShadowTest, OpenGroundUnderASlantingSoftLightIsLit) {
    const ShadowScene scene(square({0, 1, 0}, 0.5), square({0, 0, 0}, 3.0));
    optics::Light light;
    light.towards = {-1.0, 1.0, 0.3};
    light.angle = 0.1;
    const FloorRow row(-2.5, -0.5, 0.0);
    for (const PcfFilter filter : {PcfFilter::fixed, PcfFilter::penumbra}) {
        const auto shares = shadow(scene, light, row, {.map_size = 256, .filter = filter, .kernel = 5});
        for (std::size_t i = 0; i < shares.size(); ++i)
            EXPECT_EQ(shares[i], 1.0F) << "x = " << row.points[i].x << ", filter " << int(filter);
    }
}

TEST_F(PcfShadowTest, RefusesALightAmongTheCasters) {
    const ShadowScene scene(square({0, 1, 0}, 0.5), square({0, 0, 0}, 3.0));
    const FloorRow row(-1.0, 1.0, 0.0);
    EXPECT_THROW(shadow(scene, rectangle_above(1.0, 0.1), row, {}), Error);
    EXPECT_THROW(shadow(scene, rectangle_above(2.0, 0.1), row, {.map_size = 0}), Error);
}

}  // namespace
}  // namespace cairn::bench
