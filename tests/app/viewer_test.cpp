#include <algorithm>
// The viewer without its window: cameras, pace, and pictures that are rendered in slices.
#include <cmath>

#include <gtest/gtest.h>

#include "app/options/view_options.h"
#include "app/viewer/fly_camera.h"
#include "app/viewer/orbit_camera.h"
#include "app/viewer/pace.h"
#include "app/viewer/refinement.h"
#include "app/viewer/viewer.h"
#include "base/error.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using app::Command;
using app::FlyCamera;
using app::OrbitCamera;
using optics::Camera;

const optics::Camera from_the_front{.eye = {0.0, 0.0, 4.0}, .target = {0.0, 0.0, 0.0}};

void expect_near(const glm::dvec3& ours, const glm::dvec3& expected) {
    EXPECT_LT(glm::length(ours - expected), 1e-9) << ours.x << ", " << ours.y << ", " << ours.z << " is not "
                                                  << expected.x << ", " << expected.y << ", " << expected.z;
}

TEST(OrbitCamera, TurnsTheSceneAsIfGrabbed) {
    OrbitCamera orbit(from_the_front, 2.0);
    orbit.orbit({glm::radians(90.0), 0.0});
    expect_near(orbit.camera().eye, {-4.0, 0.0, 0.0});
    orbit.orbit({0.0, glm::radians(30.0)});
    expect_near(orbit.camera().eye, {-4.0 * std::cos(glm::radians(30.0)), 2.0, 0.0});
    expect_near(orbit.camera().target, {});
}

TEST(OrbitCamera, NeverTipsOverThePoles) {
    for (const double way : {10.0, -10.0}) {
        OrbitCamera orbit(from_the_front, 2.0);
        orbit.orbit({0.0, way});
        orbit.orbit({0.5, way});
        const optics::Camera& camera = orbit.camera();
        EXPECT_NEAR(glm::length(camera.eye), 4.0, 1e-9);
        EXPECT_GT(glm::length(glm::cross(glm::normalize(camera.eye), camera.up)), 0.01) << way;
    }
}

TEST(OrbitCamera, LeavesFromStraightAboveWithoutTurning) {
    OrbitCamera orbit({.eye = {0.0, 4.0, 0.0}, .target = {}, .up = {0.0, 0.0, -1.0}}, 2.0);
    orbit.orbit({0.0, -glm::radians(45.0)});
    EXPECT_NEAR(orbit.camera().eye.x, 0.0, 1e-9);
    EXPECT_GT(orbit.camera().eye.z, 1.0);
}

TEST(OrbitCamera, PanKeepsTheTargetsPlaneUnderTheMouse) {
    OrbitCamera orbit(from_the_front, 2.0);
    orbit.pan({0.5, -0.25});
    const double height = 2.0 * 4.0 * std::tan(0.5 * from_the_front.yfov);
    expect_near(orbit.camera().target, {-0.5 * height, -0.25 * height, 0.0});
    expect_near(orbit.camera().eye - orbit.camera().target, from_the_front.eye);
}

TEST(OrbitCamera, ZoomIsBoundedBothWays) {
    OrbitCamera orbit(from_the_front, 2.0);
    orbit.zoom(1.0);
    EXPECT_LT(orbit.camera().eye.z, 4.0);
    orbit.zoom(-1.0);
    EXPECT_NEAR(orbit.camera().eye.z, 4.0, 1e-9);
    orbit.zoom(1e6);
    EXPECT_GT(orbit.camera().eye.z, 0.0);
    orbit.zoom(-1e6);
    EXPECT_TRUE(std::isfinite(orbit.camera().eye.z));
}

TEST(FlyCamera, MovesAlongItsOwnWays) {
    FlyCamera fly(from_the_front, 4.0);  // speed: 1 per second
    fly.move({0.0, 0.0, 1.0}, 0.5);
    expect_near(fly.camera().eye, {0.0, 0.0, 3.5});
    fly.move({1.0, 0.0, 0.0}, 0.5);
    expect_near(fly.camera().eye, {0.5, 0.0, 3.5});
    fly.move({1.0, 1.0, 0.0}, 1.0);
    EXPECT_NEAR(glm::length(fly.camera().eye - glm::dvec3(0.5, 0.0, 3.5)), 1.0, 1e-9) << "no faster aslant";
    expect_near(fly.camera().target - fly.camera().eye, {0.0, 0.0, -4.0});
}

TEST(FlyCamera, LooksAboutFromWhereItIs) {
    FlyCamera fly(from_the_front, 4.0);
    fly.look({glm::radians(90.0), 0.0});
    expect_near(fly.camera().target, {4.0, 0.0, 4.0});
    fly.look({0.0, 10.0});
    EXPECT_LT(fly.camera().target.y, -3.9);
    EXPECT_GT(std::abs(fly.camera().target.x), 1e-3) << "short of the pole";
    expect_near(fly.camera().eye, from_the_front.eye);
}

TEST(FlyCamera, SpeedIsBounded) {
    FlyCamera fly(from_the_front, 4.0);
    fly.change_speed(2.0);
    EXPECT_GT(fly.speed(), 1.0);
    fly.change_speed(1e5);
    EXPECT_LE(fly.speed(), 40.0);
    fly.change_speed(-1e5);
    EXPECT_GT(fly.speed(), 0.0);
}

TEST(ViewerCamera, WhatIsPrintedMeansTheSameCamera) {
    for (int i = 1; i < 1800; ++i) {
        optics::Camera camera{.eye = {0.1 * i, 1.0 / i, 3.0}, .target = {1e-7 * i, -2.0, 1e6 / i}};
        camera.yfov = 0.0017 * i;
        const optics::Camera once = app::snapped(camera);
        EXPECT_TRUE(app::snapped(once) == once) << app::camera_text(camera);
        EXPECT_EQ(once.eye, camera.eye);
        EXPECT_NEAR(once.yfov, camera.yfov, 1e-10);
    }
    EXPECT_TRUE(app::camera_text(optics::Camera{}).ends_with(",45")) << app::camera_text(optics::Camera{});
}

TEST(Pace, FindsThePixelsThatFitTheTime) {
    app::Pace pace(50.0, 1000.0);
    const double ms_a_pixel = 4e-4;
    for (int i = 0; i < 40; ++i)
        pace.learn(ms_a_pixel * pace.pixels(), pace.pixels());
    EXPECT_NEAR(pace.pixels() * ms_a_pixel, 50.0, 1.0);
    const double before = pace.pixels();
    pace.learn(1e9, before);
    EXPECT_GE(pace.pixels(), 0.4 * before) << "one stall must not make the picture a blur";
}

class ViewerTest : public GlTest {
protected:
    ViewerTest() : scene_(scenes::make_builtin("knot")) {
        view_.size.width = 200;
        view_.size.height = 150;
        view_.camera = app::snapped(optics::framing_camera(scenes::take_snapshot(scene_).bounds, 4.0 / 3.0));
    }
    [[nodiscard]] renderer::Renderer make(const Settings& options = {}) const {
        return voxel_renderer(scene_, scenes::take_snapshot(scene_), options);
    }
    /// Lets the viewer work until it rests. @return the number of pieces of work
    static int rest(app::Viewer& viewer, double& now) {
        int steps = 0;
        while (viewer.rest(now) < 1e6 && steps < 5000) {
            now += std::max(viewer.rest(now), 1e-3);
            viewer.step(now);
            ++steps;
        }
        return steps;
    }
    scenes::Scene scene_;
    renderer::View view_;
};

TEST_F(ViewerTest, RowsAreThoseOfTheWholePicture) {
    renderer::Renderer renderer = make();
    const optics::Image whole = renderer.render(view_).image;
    std::vector<std::uint8_t> rows;
    for (int row = 0; row < view_.size.height; row += 37) {
        const renderer::Rows some{row, std::min(37, view_.size.height - row)};
        renderer.forget_picture();
        const optics::Image image =
            row % 2 == 0 ? renderer.render(view_, {.rows = some}).image
                         : renderer.render(view_, {.rows = some, .budget = Milliseconds(1e9)}).image;
        rows.insert(rows.end(), image.rgba.begin(), image.rgba.end());
    }
    EXPECT_EQ(rows, whole.rgba);
    for (const renderer::Rows wrong : {renderer::Rows{-1, 2}, {0, 0}, {149, 2}, {0, 151}})
        EXPECT_THROW((void)renderer.render(view_, {.rows = wrong}), Error)
            << wrong.first << " " << wrong.count;
}

TEST_F(ViewerTest, RefinesInSlicesToTheUnlimitedPicture) {
    const optics::Image expected = make().render(view_).image;
    renderer::Renderer renderer = make();
    app::Pace pace(1e-3, 4096.0);  // almost no time
    app::Refinement refinement(view_);
    int steps = 0;
    for (; !refinement.settled() && steps < 5000; ++steps)
        refinement.step(renderer, pace);
    EXPECT_TRUE(refinement.converged());
    EXPECT_GT(steps, 8) << "it was not cut in slices";
    EXPECT_EQ(refinement.image().rgba, expected.rgba);
}

TEST_F(ViewerTest, SamplesAreAddedAtRestUntilThePictureIsThatOfRender) {
    const optics::Image one = make().render(view_).image;
    view_.samples = 3;
    const optics::Image expected = make().render(view_).image;
    ASSERT_NE(expected.rgba, one.rgba);
    renderer::Renderer renderer = make();
    app::Viewer viewer(renderer, view_, 4.0);
    double now = 0.0;
    rest(viewer, now);
    EXPECT_TRUE(viewer.converged());
    EXPECT_EQ(viewer.growing().image().rgba, expected.rgba);
    viewer.command(Command::take_picture);
    rest(viewer, now);
    const std::optional<app::TakenPicture> taken = viewer.take_picture();
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->image.rgba, expected.rgba);
    EXPECT_EQ(taken->view.samples, 3) << "the line that makes it again leaves the samples out";
}

TEST_F(ViewerTest, SamplesThatThePoolsCannotHoldAreStillTaken) {
    Settings options;
    options.pools.brick_bytes = 1U << 20U;
    view_.detail.pixel_error = 0.5;
    view_.samples = 2;
    const optics::Image expected = make().render(view_).image;
    renderer::Renderer renderer = make(options);
    app::Viewer viewer(renderer, view_, 4.0);
    viewer.command(Command::take_picture);
    double now = 0.0;
    EXPECT_LT(rest(viewer, now), 10000) << "it never comes to rest";
    const std::optional<app::TakenPicture> taken = viewer.take_picture();
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->image.rgba, expected.rgba);
}

TEST_F(ViewerTest, PictureThatThePoolsCannotHoldIsStillTaken) {
    Settings options;
    options.pools.brick_bytes = 1U << 20U;
    view_.detail.pixel_error = 0.5;
    const optics::Image expected = make().render(view_).image;
    renderer::Renderer renderer = make(options);
    app::Viewer viewer(renderer, view_, 4.0);
    viewer.command(Command::take_picture);
    double now = 0.0;
    EXPECT_LT(rest(viewer, now), 5000) << "it never comes to rest";
    const std::optional<app::TakenPicture> taken = viewer.take_picture();
    ASSERT_TRUE(taken);
    int differing = 0;
    int largest = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
        const int difference = std::abs(int(taken->image.rgba[i]) - int(expected.rgba[i]));
        if (difference != 0 && differing++ == 0) first = i / 4;
        largest = std::max(largest, difference);
    }
    EXPECT_EQ(differing, 0) << "channels differ, by up to " << largest << ", from pixel ("
                            << first % std::size_t(view_.size.width) << ", "
                            << first / std::size_t(view_.size.width) << ") on";
}

TEST_F(ViewerTest, EveryInputIsShownAndComesToRestAgain) {
    renderer::Renderer renderer = make();
    app::Viewer viewer(renderer, view_, 4.0);
    double now = 0.0;
    rest(viewer, now);
    ASSERT_TRUE(viewer.converged());
    EXPECT_EQ(viewer.growing().image().rgba, make().render(view_).image.rgba);

    const auto expect_change = [&](const char* what) {
        EXPECT_EQ(viewer.rest(now), 0.0) << what << " was not seen";
        const std::size_t frames = viewer.frame_ms().size();
        rest(viewer, now);
        EXPECT_EQ(viewer.frame_ms().size(), frames + 1) << what;
        EXPECT_TRUE(viewer.converged()) << what;
        renderer.forget_picture();
        EXPECT_EQ(viewer.growing().image().rgba, renderer.render(viewer.view()).image.rgba) << what;
    };
    viewer.drag_left({0.1, 0.05});
    expect_change("orbit");
    viewer.drag_right({0.1, 0.0});
    expect_change("pan");
    viewer.wheel(2.0);
    expect_change("zoom");
    viewer.command(Command::toggle_shadow);
    expect_change("shadow");
    viewer.command(Command::next_show);
    expect_change("levels");
    viewer.command(Command::next_show);
    expect_change("bricks");
    viewer.command(Command::coarser);
    expect_change("pixel error");
    viewer.resize({120, 160});
    expect_change("size");
    viewer.command(Command::reset_camera);
    expect_change("reset");
    EXPECT_TRUE(viewer.view().camera == view_.camera);

    viewer.command(Command::toggle_fly);
    viewer.drag_left({0.05, 0.0});
    expect_change("look");
    viewer.fly({0.0, 0.0, 1.0});
    viewer.step(now += 0.05);
    viewer.fly({});
    now += 0.05;
    rest(viewer, now);
    EXPECT_LT(viewer.view().camera.eye.z, view_.camera.eye.z) << "it did not fly ahead";
}

TEST_F(ViewerTest, TreeIsShownByLevelsAndBricks) {
    renderer::Renderer renderer = make();
    const optics::Image surface = renderer.render(view_).image;
    view_.show = renderer::Show::bricks;
    const optics::Image bricks = renderer.render(view_).image;
    view_.show = renderer::Show::levels;
    const optics::Image levels = renderer.render(view_).image;
    std::size_t covered = 0, of_level = 0, marked = 0;
    // At this size the whole knot is shown at one level: all its pixels have the hue of that level.
    for (std::size_t i = 0; i < surface.rgba.size(); i += 4) {
        if (surface.rgba[i + 3] != 255) continue;
        ++covered;
        marked += !std::equal(&surface.rgba[i], &surface.rgba[i] + 3, &bricks.rgba[i]) ? 1 : 0;
        of_level += !std::equal(&surface.rgba[i], &surface.rgba[i] + 3, &levels.rgba[i]) ? 1 : 0;
    }
    EXPECT_GT(of_level, covered * 99 / 100);
    EXPECT_GT(marked, covered / 50);
    EXPECT_LT(marked, covered / 2) << "lines, not areas";
    for (int level = 1; level < 6; ++level)
        EXPECT_GT(glm::length(renderer::shown_level_color(level) - renderer::shown_level_color(level - 1)),
                  0.5F);
}

}  // namespace
}  // namespace cairn::test
