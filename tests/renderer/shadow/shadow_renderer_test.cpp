// All methods of shadows through ShadowRenderer: one scene, moving moments, and the limits of each method.

#include "renderer/shadow_renderer.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/shadow_truth.h"
#include "scenes/ground.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/moving_scenes.h"
#include "tests/support/soft_shadow_scene.h"

namespace cairn::test {
namespace {

using renderer::make_shadow_renderer;
using renderer::ShadowMethod;
using renderer::ShadowOptions;
using renderer::ShadowPicture;
using renderer::ShadowQuality;
using renderer::View;

constexpr std::array methods = {ShadowMethod::voxel, ShadowMethod::pyramid, ShadowMethod::soft_shadow_map};

class ShadowRenderers : public GlTest {};

std::string name_of(ShadowMethod method) {
    return method == ShadowMethod::voxel     ? "voxel"
           : method == ShadowMethod::pyramid ? "pyramid"
                                             : "soft shadow map";
}

View view_under(const optics::Light& light) {
    View view;
    view.size = {96, 72};
    view.camera = {.eye = {2.0, 3.0, 4.0}, .target = {0.0, 0.2, 0.0}, .up = {0, 1, 0}, .yfov = 0.8};
    view.light = light;
    view.shadow = {.kind = ShadowQuality::Kind::rays, .samples = 64};
    return view;
}

/// A ball over a floor.
struct Ball {
    ShadowScene made{ball({0.0, 0.8, 0.0}, 0.4, 4), square({0.0, 0.0, 0.0}, 1.5)};
    scenes::NodeSelection floor{true, false}, thing{false, true};

    [[nodiscard]] renderer::ShadowScene scene(ShadowMethod method) const {
        if (method != ShadowMethod::soft_shadow_map) return {made.scene, made.whole};
        return {made.scene, made.whole, thing, floor};
    }
};

void expect_refused(const std::function<void()>& call, const std::string& part) {
    try {
        call();
        FAIL() << "not refused: " << part;
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage) << part;
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        EXPECT_FALSE(error.way_out().empty()) << part;
    }
}

TEST_F(ShadowRenderers, AllAreNearTheSameTruth) {
    const Ball ball;
    View view = view_under(optics::aimed_light({0.6, 3.0, 1.6}, {0.0, 0.5, 0.0}, 0.5, 0.5));
    // Shadows are no sharper than voxels, and pixels are large here.
    view.detail.pixel_error = 0.1;
    const reference::ImageTracer tracer(ball.made.scene, ball.made.whole);
    const reference::ShadowQuestion question{ball.made.scene, ball.made.whole, ball.floor,      view.camera,
                                             view.light,      view.size.width, view.size.height};
    const auto receivers = reference::shadow_receivers(tracer, question);
    const auto truth =
        reference::soft_shares(tracer, question, receivers, {.standard_error = 1.0 / 128}).shares;
    for (const ShadowMethod method : methods) {
        const auto shadows = make_shadow_renderer(method, ball.scene(method));
        const ShadowPicture picture = shadows->render(view);
        const reference::ShadowError error = reference::shadow_error(picture.light.shares, truth);
        EXPECT_GT(error.pixels, 800U) << name_of(method);
        EXPECT_GT(error.shadowed, 50U) << name_of(method);
        EXPECT_LT(error.rmse(), 0.05) << name_of(method);
        EXPECT_EQ(picture.image.width, view.size.width);
        EXPECT_EQ(picture.image.height, view.size.height);
        EXPECT_EQ(picture.image.rgba.size(), 4 * picture.light.shares.size());
        EXPECT_GT(picture.times.milliseconds, 0.0) << name_of(method);
        EXPECT_GT(picture.times.shadow_ms, 0.0) << name_of(method);
        EXPECT_LE(picture.times.shadow_ms, picture.times.milliseconds) << name_of(method);
    }
}

// The parts of a picture do not depend on the other parts of the request, nor on pictures before.
TEST_F(ShadowRenderers, PartsAreThoseOfTheWhole) {
    const Ball ball;
    const View view = view_under(light_above(3.0, 0.3, 0.3));
    for (const ShadowMethod method : methods) {
        const auto shadows = make_shadow_renderer(method, ball.scene(method));
        const ShadowPicture whole = shadows->render(view);
        const ShadowPicture image = shadows->render(view, {.light = false});
        const ShadowPicture light = shadows->render(view, {.image = false});
        EXPECT_TRUE(image.image.rgba == whole.image.rgba) << name_of(method);
        EXPECT_TRUE(light.light.shares == whole.light.shares) << name_of(method);
        EXPECT_TRUE(image.light.shares.empty()) << name_of(method);
        EXPECT_TRUE(light.image.rgba.empty()) << name_of(method);
        EXPECT_FALSE(light.times.has_prepared) << name_of(method);
        EXPECT_EQ(whole.times.has_prepared, method != ShadowMethod::soft_shadow_map) << name_of(method);
    }
}

TEST_F(ShadowRenderers, ThoseThatMoveShowWhatOneMadeThenShows) {
    scenes::Scene scene = moving_zoo(7);
    const scenes::When start{0.0, 0, std::nullopt};
    const scenes::Bounds bounds = scenes::bounds_over_animation(scene, start, 8.0);
    scenes::add_ground(scene, bounds);
    scenes::NodeSelection ground(scene.nodes.size(), false);
    ground.back() = true;
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double size = glm::length(bounds.high - bounds.low);
    View view = view_under(
        optics::aimed_light(middle + size * glm::dvec3(0.3, 1.2, 0.2), middle, 0.2 * size, 0.2 * size));
    view.camera = optics::framing_camera(bounds, view.size.aspect());
    view.shadow.samples = 4;
    const ShadowOptions options{.pyramid = {.resolution = 64},
                                .map = {.occluder_size = 48, .receiver_size = 48}};
    for (const ShadowMethod method : {ShadowMethod::pyramid, ShadowMethod::soft_shadow_map}) {
        const auto made_at = [&](const scenes::Snapshot& snapshot, const scenes::When& when) {
            renderer::ShadowScene shown{.scene = scene, .snapshot = snapshot};
            shown.motion = renderer::ShadowMotion{when, bounds};
            if (method == ShadowMethod::soft_shadow_map) {
                shown.casters = scenes::other_nodes(ground);
                shown.receivers = ground;
            }
            return make_shadow_renderer(method, shown, options);
        };
        const scenes::Snapshot first = scenes::take_snapshot(scene, start);
        const auto moving = made_at(first, start);
        std::vector<float> before;
        for (const double seconds : {0.4, 1.9, 1.1, 0.4}) {
            moving->move_to(seconds);
            const ShadowPicture picture = moving->render(view);
            scenes::When when = start;
            when.seconds = seconds;
            const scenes::Snapshot snapshot = scenes::take_snapshot(scene, when);
            const ShadowPicture fresh = made_at(snapshot, when)->render(view);
            EXPECT_TRUE(picture.image.rgba == fresh.image.rgba) << name_of(method) << " at " << seconds;
            EXPECT_TRUE(picture.light.shares == fresh.light.shares) << name_of(method) << " at " << seconds;
            EXPECT_FALSE(picture.light.shares == before) << name_of(method) << " at " << seconds;
            EXPECT_GT(picture.times.move_ms, 0.0) << name_of(method);
            before = picture.light.shares;
        }
    }
}

TEST_F(ShadowRenderers, RefuseMomentsThatTheyCannotShow) {
    const Ball ball;
    for (const ShadowMethod method : methods) {
        const auto shadows = make_shadow_renderer(method, ball.scene(method));
        expect_refused([&] { shadows->move_to(1.0); }, "one moment");
    }
    renderer::ShadowScene moving = ball.scene(ShadowMethod::voxel);
    moving.motion = renderer::ShadowMotion{{}, ball.made.whole.bounds};
    expect_refused([&] { (void)make_shadow_renderer(ShadowMethod::voxel, moving); }, "one moment");
}

TEST_F(ShadowRenderers, RefuseCastersAndReceiversThatTheyCannotTellApart) {
    const Ball ball;
    for (const ShadowMethod method : {ShadowMethod::voxel, ShadowMethod::pyramid}) {
        expect_refused([&] { (void)make_shadow_renderer(method, ball.scene(ShadowMethod::soft_shadow_map)); },
                       "node 0 \"floor\" shall throw no shadow");
        renderer::ShadowScene all = ball.scene(method);
        all.casters = all.receivers = scenes::NodeSelection(2, true);
        EXPECT_NO_THROW((void)make_shadow_renderer(method, all)) << name_of(method);
        all.receivers = ball.floor;
        expect_refused([&] { (void)make_shadow_renderer(method, all); },
                       "node 1 \"thing\" shall take no shadow");
        all.receivers = scenes::NodeSelection(3, true);
        expect_refused([&] { (void)make_shadow_renderer(method, all); }, "3 flags");
    }
    expect_refused(
        [&] { (void)make_shadow_renderer(ShadowMethod::soft_shadow_map, ball.scene(ShadowMethod::voxel)); },
        "both occluder and receiver");
}

TEST_F(ShadowRenderers, RefuseViewsThatTheyCannotShow) {
    const Ball ball;
    const View view = view_under(light_above(3.0, 0.3, 0.3));
    const auto refused = [&](ShadowMethod method, const std::function<void(View&)>& change,
                             const std::string& part) {
        View other = view;
        change(other);
        const auto shadows = make_shadow_renderer(method, ball.scene(method));
        expect_refused([&] { (void)shadows->render(other); }, part);
    };
    const auto cones = [](View& v) { v.shadow.kind = ShadowQuality::Kind::cones; };
    const auto levels = [](View& v) { v.show = renderer::Show::levels; };
    refused(ShadowMethod::pyramid, cones, "cones");
    refused(ShadowMethod::pyramid, levels, "levels");
    refused(ShadowMethod::soft_shadow_map, levels, "levels");
    for (const auto kind : {ShadowQuality::Kind::none, ShadowQuality::Kind::hard, ShadowQuality::Kind::cones})
        refused(
            ShadowMethod::soft_shadow_map, [kind](View& v) { v.shadow.kind = kind; }, "whole light");
    for (const auto shape : {optics::LightShape::sphere, optics::LightShape::disk})
        refused(
            ShadowMethod::soft_shadow_map, [shape](View& v) { v.light.shape = shape; }, "no rectangle");
    refused(
        ShadowMethod::soft_shadow_map, [](View& v) { v.light.positional = false; }, "no rectangle");
    for (const ShadowMethod method : {ShadowMethod::voxel, ShadowMethod::pyramid}) {
        const auto shadows = make_shadow_renderer(method, ball.scene(method));
        for (const auto shape :
             {optics::LightShape::sphere, optics::LightShape::disk, optics::LightShape::rectangle}) {
            View other = view;
            other.light.shape = shape;
            other.light.radius = 0.2;
            EXPECT_NO_THROW((void)shadows->render(other)) << name_of(method);
        }
    }
}

}  // namespace
}  // namespace cairn::test
