// The projection of the soft shadow map onto the scene: the value of the map that each pixel takes.

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/image.h"
#include "reference/shadow_truth.h"
#include "renderer/shadow/map_shadows.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/soft_shadow_scene.h"
#include "tests/support/textured_scene.h"

namespace cairn::test {
namespace {

using glm::dvec3;
using optics::Light;
using renderer::MapShadows;
using renderer::ShadowPicture;
using renderer::View;

class SoftShadowPictures : public GlTest {};

scenes::NodeSelection only(std::size_t node, std::size_t count) {
    scenes::NodeSelection selection(count, false);
    selection[node] = true;
    return selection;
}

MapShadows renderer_of(const ShadowScene& scene, const renderer::SoftShadowOptions& options = {}) {
    return MapShadows({scene.scene, scene.whole, only(1, 2), only(0, 2)}, options);
}

View view_of(const Light& light) {
    View view;
    view.size = {120, 90};
    view.camera = {.eye = {2.0, 3.0, 4.0}, .target = {0.0, 0.2, 0.0}, .up = {0, 1, 0}, .yfov = 0.8};
    view.light = light;
    view.shadow.kind = renderer::ShadowQuality::Kind::rays;
    return view;
}

/// The points that Embree sees through the same pixels, and the share of the light there.
struct Truth {
    reference::ReferenceImage image;
    std::vector<double> visible;  ///< share of the light; 1 if there is no point
};

dvec3 direction_of(const View& view, int x, int y) {
    const dvec3 forward = glm::normalize(view.camera.target - view.camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, view.camera.up));
    const double half = std::tan(0.5 * view.camera.yfov);
    const double across = (2.0 * x + 1.0) / view.size.width - 1.0;
    const double above = 1.0 - (2.0 * y + 1.0) / view.size.height;
    return glm::normalize(forward + across * half * view.size.width / view.size.height * right +
                          above * half * glm::cross(right, forward));
}

Truth truth_of(const ShadowScene& scene, const View& view) {
    const reference::ImageTracer all(scene.scene, scene.whole);
    const reference::ImageTracer occluders(scene.scene, scene.occluders);
    Truth truth;
    truth.image = all.trace(view.camera, {}, view.size.width, view.size.height);
    std::vector<dvec3> points;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const float depth = truth.image.depth[std::size_t(y * view.size.width + x)];
            points.push_back(view.camera.eye +
                             (std::isfinite(depth) ? double(depth) : 0.0) * direction_of(view, x, y));
        }
    }
    for (const reference::LightVisibility& visibility : reference::area_light_visibility(
             occluders, points, {}, view.light, {.standard_error = 0.006, .most_samples = 2048}))
        truth.visible.push_back(visibility.visible);
    return truth;
}

TEST_F(SoftShadowPictures, PixelsSeeTheLightThatRaysSee) {
    Corners floor = square({0.0, 0.0, 0.0}, 1.5);
    const Corners slope = quad({-1.5, 0, -1.5}, {1.5, 0, -1.5}, {1.5, 1.0, -2.2}, {-1.5, 1.0, -2.2});
    floor.insert(floor.end(), slope.begin(), slope.end());
    const ShadowScene scene(ball({0.0, 0.8, 0.0}, 0.4, 4), floor);
    const View view = view_of(optics::aimed_light({0.6, 3.0, 1.6}, {0.0, 0.5, 0.0}, 0.5, 0.5));
    MapShadows shadows = renderer_of(scene);
    const ShadowPicture picture = shadows.render(view);
    const Truth truth = truth_of(scene, view);
    double sum = 0.0;
    int shadowed = 0;
    int receivers = 0;
    int mismatched = 0;  // a pixel's centre on an edge belongs to either side
    for (std::size_t i = 0; i < truth.visible.size(); ++i) {
        const bool floor_seen = truth.image.primitive[i] < floor.size() / 3;
        const bool same = floor_seen == (picture.light.shares[i] >= 0.0F) &&
                          std::isfinite(shadows.distances()[i]) == std::isfinite(truth.image.depth[i]);
        if (!same) ++mismatched;
        if (!same || !floor_seen) continue;
        ++receivers;
        EXPECT_NEAR(shadows.distances()[i], truth.image.depth[i], 1e-3) << "pixel " << i;
        if (truth.visible[i] >= 1.0 && picture.light.shares[i] >= 1.0F) continue;
        ++shadowed;
        sum += std::abs(truth.visible[i] - double(picture.light.shares[i]));
    }
    EXPECT_LT(mismatched, view.size.width * view.size.height / 200);
    EXPECT_GT(receivers, view.size.width * view.size.height / 5);
    EXPECT_GT(shadowed, 150);
    EXPECT_LT(sum / shadowed, 0.03);
}

TEST_F(SoftShadowPictures, ShadowIsDarkerAndTheRestIsAsWithoutIt) {
    const ShadowScene scene(square({0.0, 0.8, 0.0}, 0.4), square({0.0, 0.0, 0.0}, 1.5));
    const View view = view_of(light_above(3.0, 0.3, 0.3));
    MapShadows shadows = renderer_of(scene);
    const ShadowPicture picture = shadows.render(view);
    const ShadowPicture bare =
        MapShadows({scene.scene, scene.whole, scenes::NodeSelection(2, false), only(0, 2)}).render(view);
    int dark = 0;
    for (std::size_t i = 0; i < picture.light.shares.size(); ++i) {
        if (picture.light.shares[i] < 0.0F) continue;
        const int difference = int(bare.image.rgba[4 * i]) - int(picture.image.rgba[4 * i]);
        if (picture.light.shares[i] >= 1.0F) {
            EXPECT_EQ(difference, 0) << "lit pixel " << i;
        } else if (picture.light.shares[i] < 0.9F) {
            EXPECT_GT(difference, 3) << "shadowed pixel " << i << ", visible " << picture.light.shares[i];
            ++dark;
        }
    }
    EXPECT_GT(dark, 200);
    EXPECT_EQ(picture.image.rgba[3], 0) << "the background has no coverage";
}

/// A floor with a texture under a small occluder, seen at a low angle.
ShadowPicture textured_floor(int side, std::vector<std::uint8_t> rgba, scenes::AlphaMode mode,
                             float per_length) {
    ShadowScene scene(square({0.0, 0.8, 0.0}, 0.05), square({0.0, 0.0, 0.0}, 1.5));
    paint_from_above(scene.scene, scene.scene.meshes[0].primitives[0], side, std::move(rgba), mode,
                     per_length);
    View view = view_of(light_above(3.0, 0.3, 0.3));
    view.light.ambient = 1.0F;  // every point of the floor is lit alike
    view.camera.eye = {1.0, 0.8, 2.5};
    return renderer_of(scene).render(view);
}

TEST_F(SoftShadowPictures, TexturesFinerThanPixelsAreMeans) {
    const ShadowPicture picture =
        textured_floor(64, checkerboard(64, opaque_white, opaque_black), scenes::AlphaMode::opaque, 16.0F);
    int seen = 0;
    for (std::size_t i = 0; i < picture.light.shares.size(); ++i) {
        if (picture.light.shares[i] < 0.0F || picture.image.rgba[4 * i + 3] != 255) continue;
        ++seen;
        ASSERT_NEAR(picture.image.rgba[4 * i], 188, 3) << "pixel " << i;
    }
    EXPECT_GT(seen, 1000);
}

TEST_F(SoftShadowPictures, ColoursThatAMaskHidesAreNowhere) {
    for (const float per_length : {0.25F, 1.0F, 4.0F}) {
        const ShadowPicture picture = textured_floor(16, checkerboard(16, kept_green, hidden_magenta),
                                                     scenes::AlphaMode::mask, per_length);
        int seen = 0;
        for (std::size_t i = 0; i < picture.light.shares.size(); ++i) {
            if (picture.light.shares[i] < 0.0F) continue;
            ++seen;
            ASSERT_LE(picture.image.rgba[4 * i], 1) << "pixel " << i << ", " << per_length;
            ASSERT_LE(picture.image.rgba[4 * i + 2], 1) << "pixel " << i << ", " << per_length;
        }
        EXPECT_GT(seen, 500) << per_length;
    }
}

// A window around a corner of the floor: what lies outside is lit, as documented.
TEST_F(SoftShadowPictures, OutsideTheLightsWindowAllIsLit) {
    const ShadowScene scene(square({0.0, 0.8, 0.0}, 0.4), square({0.0, 0.0, 0.0}, 1.5));
    const View view = view_of(light_above(3.0, 0.3, 0.3));
    const renderer::ShadowFrustum frustum{0.1, {{-0.3, -0.3}, {0.3, 0.3}}, {{0.0, 0.0}, {0.5, 0.5}}};
    MapShadows shadows = renderer_of(scene);
    shadows.set_frustum(frustum);
    const ShadowPicture picture = shadows.render(view);
    int inside = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const std::size_t i = std::size_t(y * view.size.width + x);
            if (picture.light.shares[i] < 0.0F) continue;
            const dvec3 point = view.camera.eye + double(shadows.distances()[i]) * direction_of(view, x, y);
            if (point.x < -0.01 || point.z < -0.01) {
                EXPECT_EQ(picture.light.shares[i], 1.0F) << "pixel (" << x << ", " << y << ")";
            }
            inside += picture.light.shares[i] < 0.5F ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 50);
}

/// A square whose texture is opaque in one half and a hole in the other.
ShadowScene half_masked() {
    ShadowScene scene(square({0.0, 1.0, 0.0}, 0.5), square({0.0, 0.0, 0.0}, 1.5));
    scenes::Image image;
    image.width = 2;
    image.height = 1;
    image.rgba = {255, 0, 0, 255, 255, 0, 0, 0};
    scene.scene.images.push_back(image);
    scene.scene.textures.push_back({0, scenes::Wrap::clamp_to_edge, scenes::Wrap::clamp_to_edge});
    scenes::Material material;
    material.texture = 0;
    material.alpha_mode = scenes::AlphaMode::mask;
    scene.scene.materials.push_back(material);
    scenes::Primitive& primitive = scene.scene.meshes[1].primitives[0];
    primitive.material = 0;
    for (const glm::vec3& p : primitive.positions)
        primitive.texcoords.emplace_back(p.x + 0.5F, 0.5F);
    return scene;
}

TEST_F(SoftShadowPictures, HolesOfAnAlphaMaskLetTheLightThrough) {
    const ShadowScene scene = half_masked();
    const Light light = light_above(3.0, 0.01, 0.01);
    const renderer::SoftShadowMap map = shadow_of(scene, light, {.occluder_size = 64, .receiver_size = 64});
    EXPECT_EQ(map.statistics().micro_patches, 2U * 32U * 64U);
    for (const ReceiverPoint& point : receiver_points(map)) {
        if (std::abs(point.position.x) < 0.05 || std::abs(point.position.x) > 0.7 ||
            std::abs(point.position.y) > 0.7)
            continue;
        EXPECT_NEAR(point.visible, point.position.x < 0.0 ? 0.0 : 1.0, 1e-4)
            << "texel (" << point.x << ", " << point.y << ")";
    }
    // The hole shows the floor, the rest is red.
    MapShadows shadows = renderer_of(scene);
    View view = view_of(light);
    view.camera = {.eye = {0.0, 4.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0, 0, -1}, .yfov = 0.5};
    const ShadowPicture picture = shadows.render(view);
    const auto at = [&](int x) { return std::size_t(45 * view.size.width + x); };
    EXPECT_EQ(picture.light.shares[at(50)], -1.0F);
    EXPECT_GT(picture.image.rgba[4 * at(50)], picture.image.rgba[4 * at(50) + 1] + 50);
    EXPECT_GE(picture.light.shares[at(70)], 0.0F);
}

TEST_F(SoftShadowPictures, RefusesNodesThatAreBothAndPicturesThatAreNone) {
    const ShadowScene scene(square({0.0, 0.8, 0.0}, 0.4), square({0.0, 0.0, 0.0}, 1.5));
    const auto refused = [](const auto& call) {
        try {
            call();
        } catch (const Error& error) {
            return error.fault() == Fault::usage;
        }
        return false;
    };
    EXPECT_TRUE(refused([&] {
        (void)MapShadows({scene.scene, scene.whole, scenes::NodeSelection(2, true), only(0, 2)});
    }));
    MapShadows shadows = renderer_of(scene);
    View view = view_of(light_above(3.0, 0.3, 0.3));
    view.size.width = 0;
    EXPECT_TRUE(refused([&] { (void)shadows.render(view); }));
}

// OpenGL's state is the same before and after a picture.
TEST_F(SoftShadowPictures, LeaveTheDrawStateAlone) {
    const ShadowScene scene(square({0.0, 0.8, 0.0}, 0.4), square({0.0, 0.0, 0.0}, 1.5));
    glEnable(GL_CULL_FACE);
    glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
    glBlendFunc(GL_DST_COLOR, GL_ZERO);
    (void)renderer_of(scene, {.occluder_size = 32, .receiver_size = 32})
        .render(view_of(light_above(3.0, 0.3, 0.3)));
    GLint equation = 0;
    GLint source = 0;
    glGetIntegerv(GL_BLEND_EQUATION_RGB, &equation);
    glGetIntegerv(GL_BLEND_SRC_RGB, &source);
    EXPECT_EQ(equation, GL_FUNC_REVERSE_SUBTRACT);
    EXPECT_EQ(source, GL_DST_COLOR);
    EXPECT_EQ(glIsEnabled(GL_CULL_FACE), GL_TRUE);
    EXPECT_EQ(glIsEnabled(GL_BLEND), GL_FALSE);
    EXPECT_EQ(glIsEnabled(GL_FRAMEBUFFER_SRGB), GL_FALSE);
}

#ifdef CAIRN_SCENE_DATA
// The bunny on the floor: contact, folds, holes. Two passes, as figure 17 of Atty et al. charts it.
TEST_F(SoftShadowPictures, BunnyOnTheFloorIsNearTheTruth) {
    const scenes::Scene file = scenes::load(CAIRN_SCENE_DATA "/gltf/stanford_bunny_69k.glb");
    const scenes::Snapshot snapshot = scenes::take_snapshot(file);
    const dvec3 low = snapshot.bounds.low;
    const dvec3 extent = snapshot.bounds.high - low;
    Corners bunny;
    for (const scenes::Item& item : snapshot.items) {
        for (const std::uint32_t index : item.primitive->indices) {
            const dvec3 p = item.world(index);
            bunny.push_back((p - low - 0.5 * dvec3(extent.x, 0.0, extent.z)) * (1.2 / extent.y));
        }
    }
    const ShadowScene scene(bunny, square({0.0, 0.0, 0.0}, 2.0));
    const Light light = optics::aimed_light({1.5, 2.6, 0.4}, {0.0, 0.4, 0.0}, 0.4, 0.4);
    const renderer::SoftShadowMap map = shadow_of(scene, light, {.occluder_size = 128, .receiver_size = 48});
    const std::vector<ReceiverPoint> points = receiver_points(map);
    const reference::ImageTracer tracer(scene.scene, scene.occluders);
    const glm::dmat4 world_from_light = glm::inverse(optics::light_from_world(light));
    std::vector<dvec3> world;
    for (const ReceiverPoint& point : points)
        world.emplace_back(world_from_light * glm::dvec4(point.position, 1.0));
    std::vector<double> truth;
    for (const reference::LightVisibility& visibility : reference::area_light_visibility(
             tracer, world, {}, light, {.standard_error = 0.005, .most_samples = 4096}))
        truth.push_back(visibility.visible);
    const ShadowError error = error_of(points, truth);
    EXPECT_LT(error.mean, 0.03) << error.worst;
    EXPECT_GT(error.shadowed, 300U);
}
#endif

}  // namespace
}  // namespace cairn::test
