// Pictures with shadow rays through the xy-reduced pyramid, of scenes at rest and in motion.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "reference/shadow_truth.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "renderer/shadow/pyramid_shadows.h"
#include "scenes/ground.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/moving_scenes.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"
#include "voxelizer/surface/moving_surface.h"

namespace cairn::test {
namespace {

using renderer::ColumnMask;
using renderer::PyramidShadows;
using renderer::View;

View view_of(const scenes::Bounds& bounds, int width, int height, int rays) {
    View view;
    view.size.width = width;
    view.size.height = height;
    view.camera = optics::framing_camera(bounds, double(width) / height);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double size = glm::length(bounds.high - bounds.low);
    view.light.positional = true;
    view.light.position = middle + size * glm::dvec3(0.5, 0.9, 0.3);
    view.light.radius = 0.12 * size;
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = rays};
    view.detail.pixel_error = 1e-6;
    return view;
}

scenes::When moment(double seconds) {
    return {seconds, 0, std::nullopt};
}

const renderer::ShadowRequest only_image = {.light = false};
const renderer::ShadowRequest only_light = {.image = false};

/// @param snapshot  the scene at the moment.
renderer::ShadowScene moving_scene(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                   const scenes::When& when, const scenes::Bounds& bounds) {
    return {.scene = scene, .snapshot = snapshot, .motion = renderer::ShadowMotion{when, bounds}};
}

class PyramidPictures : public GlTest {};

TEST_F(PyramidPictures, PenumbraOfASquareComesToTheClosedForm) {
    // square_over_floor(), lit from height 3 by a square of half side 0.4.
    const scenes::Scene scene = square_over_floor();
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    PyramidShadows pyramid({scene, snapshot}, {.resolution = 512});
    View view;
    view.size.width = view.size.height = 96;
    view.camera = {.eye = {0.0, 8.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 0.5};
    view.light.positional = true;
    view.light.position = {0.1, 3.0, 0.0};
    view.light.shape = optics::LightShape::rectangle;
    view.light.half_u = {0.4, 0.0, 0.0};
    view.light.half_v = {0.0, 0.0, 0.4};
    const PictureRays rays(view);
    const auto hidden = [](double at, double middle) {
        const double low = at + (-0.5 - at) * 3.0 - middle;
        const double high = at + (0.5 - at) * 3.0 - middle;
        return std::max(0.0, std::min(high, 0.4) - std::max(low, -0.4)) / 0.8;
    };
    for (const auto& [count, limit] : {std::pair{16, 0.05}, {64, 0.025}, {512, 0.02}}) {
        view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = count};
        const renderer::ShadowPicture picture = pyramid.render(view, only_light);
        const std::vector<float>& shares = picture.light.shares;
        if (count == 512) {
            EXPECT_GT(picture.times.passes, 1) << "no ray paused: the test says less";
        }
        double squares = 0.0;
        int penumbra = 0;
        for (int y = 0; y < view.size.height; ++y) {
            for (int x = 0; x < view.size.width; ++x) {
                const glm::dvec3 direction = rays.direction({x + 0.5, y + 0.5});
                const auto at = [&](double height) {
                    return rays.eye - direction * ((rays.eye.y - height) / direction.y);
                };
                const glm::dvec3 top = at(1.0);
                const glm::dvec3 floor = at(0.0);
                const double share = shares[std::size_t(y * view.size.width + x)];
                const double edge = std::max(std::abs(top.x), std::abs(top.z));
                if (edge < 0.48) {
                    ASSERT_EQ(share, 1.0) << "the square at pixel (" << x << ", " << y << ")";
                }
                if (edge < 0.52 || std::max(std::abs(floor.x), std::abs(floor.z)) > 1.95) continue;
                const double truth = 1.0 - hidden(floor.x, 0.1) * hidden(floor.z, 0.0);
                if (truth < 0.01 || truth > 0.99) continue;
                ++penumbra;
                squares += (share - truth) * (share - truth);
            }
        }
        EXPECT_GT(penumbra, 800);
        const double rmse = std::sqrt(squares / penumbra);
        RecordProperty(fmt::format("rays_{}", count), fmt::format("{:.4f} over {} pixels", rmse, penumbra));
        EXPECT_LT(rmse, limit) << count << " rays";
    }
}

TEST_F(PyramidPictures, AreAsNearToEmbreeAsThoseOfTheTree) {
    scenes::Scene scene = scenes::make_builtin("knot");
    scenes::add_ground(scene, scenes::take_snapshot(scene).bounds);
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const reference::ImageTracer tracer(scene, snapshot);
    const scenes::NodeSelection all(scene.nodes.size(), true);
    for (const int rays : {1, 32}) {
        const View view = view_of(snapshot.bounds, 160, 120, rays);
        const reference::ShadowQuestion question{
            scene, snapshot, all, view.camera, view.light, view.size.width, view.size.height};
        const auto receivers = reference::shadow_receivers(tracer, question);
        const auto truth = rays == 1
                               ? reference::hard_shares(receivers)
                               : reference::soft_shares(tracer, question, receivers,
                                                        {.standard_error = 1.0 / 256, .least_samples = 64})
                                     .shares;
        PyramidShadows pyramid({scene, snapshot}, {.resolution = 512});
        const auto error_of_tree = [&](renderer::VoxelGeometry geometry) {
            renderer::Renderer tree = voxel_renderer(
                scene, snapshot, {.tree = {.n = 2, .m = 16, .max_resolution = 128, .geometry = geometry}});
            tree.set_mix({.meshes = std::make_shared<renderer::MeshRaster>(scene, snapshot),
                          .mesh_shadows = true,
                          .meshes_are_voxelized = true,
                          .voxels_hidden = true});
            return reference::shadow_error(tree.light(view).light.shares, truth);
        };
        const auto ours = reference::shadow_error(pyramid.render(view, only_light).light.shares, truth);
        // The marks of the tree's voxels are the pyramid's voxels.
        const auto theirs = error_of_tree(renderer::VoxelGeometry::marks);
        EXPECT_LT(1.5 * error_of_tree(renderer::VoxelGeometry::both).rmse(), theirs.rmse())
            << "slabs are sharper, " << rays << " rays";
        RecordProperty(fmt::format("rays_{}", rays),
                       fmt::format("pyramid {:.4f} tree {:.4f} wrong, rmse {:.4f} and {:.4f}",
                                   ours.disagreement(), theirs.disagreement(), ours.rmse(), theirs.rmse()));
        EXPECT_GT(ours.shadowed, 200U);
        EXPECT_LT(ours.disagreement(), theirs.disagreement() + 0.002) << rays << " rays";
        // Bits have no place of the surface within a voxel, which the tree's voxels have.
        EXPECT_LT(ours.rmse(), 1.25 * theirs.rmse()) << rays << " rays";
        EXPECT_LT(ours.disagreement(), 0.02) << rays << " rays";
    }
}

TEST_F(PyramidPictures, AreTheSameWhateverMaskFindsThem) {
    const scenes::Scene scene = scenes::make_builtin("spheres");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const View view = view_of(snapshot.bounds, 96, 72, 8);
    for (const int resolution : {8, 64, 256}) {
        std::vector<std::uint8_t> first;
        for (const ColumnMask mask : {ColumnMask::adaptive, ColumnMask::mip_level}) {
            PyramidShadows pyramid({scene, snapshot}, {.resolution = resolution, .mask = mask});
            const auto picture = pyramid.render(view, only_image).image.rgba;
            if (first.empty()) first = picture;
            EXPECT_EQ(picture, first) << resolution << ", mask " << int(mask);
            EXPECT_EQ(pyramid.render(view, only_image).image.rgba, first)
                << "again: " << resolution << ", mask " << int(mask);
        }
    }
}

TEST_F(PyramidPictures, WithoutShadowsThePictureIsThatOfTheMeshes) {
    const scenes::Scene scene = ball_over_floor();
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view = view_of(snapshot.bounds, 80, 60, 1);
    PyramidShadows pyramid({scene, snapshot}, {.resolution = 64});
    const auto hard = pyramid.render(view, only_image).image.rgba;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    const auto none = pyramid.render(view, only_image).image.rgba;
    EXPECT_NE(none, hard);
    renderer::Renderer tree = voxel_renderer(scene, snapshot, {.tree = {.max_resolution = 64}});
    tree.set_mix({.meshes = std::make_shared<renderer::MeshRaster>(scene, snapshot), .voxels_hidden = true});
    const auto truth = tree.render(view).image.rgba;
    // The two round vertices to lattices of their own.
    std::size_t apart = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        apart += std::abs(int(truth[i]) - int(none[i])) > 1 ? 1 : 0;
    EXPECT_LT(apart, truth.size() / 500);
}

TEST_F(PyramidPictures, WhatCannotBeIsRefused) {
    const scenes::Scene scene = square_over_floor();
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    for (const int resolution : {0, 100, 4096})
        EXPECT_THROW(PyramidShadows({scene, snapshot}, {.resolution = resolution}), Error);
    PyramidShadows pyramid({scene, snapshot}, {.resolution = 64});
    EXPECT_THROW(pyramid.move_to(1.0), Error);
    View view = view_of(snapshot.bounds, 32, 32, 1);
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 513};
    EXPECT_THROW((void)pyramid.render(view), Error);
    scenes::Scene nothing;
    nothing.scenes.resize(1);
    const scenes::Snapshot no_items = scenes::take_snapshot(nothing);
    PyramidShadows empty({nothing, no_items}, {.resolution = 64});
    view.shadow = {.kind = renderer::ShadowQuality::Kind::rays, .samples = 1};
    for (const float share : empty.render(view, only_light).light.shares)
        ASSERT_EQ(share, -1.0F);
}

/// The resident memory of this process, in MiB.
double resident_mib() {
    std::ifstream statm("/proc/self/statm");
    double total = 0.0;
    double resident = 0.0;
    statm >> total >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / 0x1p20;
}

/// Moves through the times, and compares with renderers that are made at each time.
/// @return  number of frames that differ from the one before
int expect_fresh_frames(const scenes::Scene& scene, const scenes::Bounds& bounds,
                        const std::vector<double>& times) {
    const View view = view_of(bounds, 80, 60, 4);
    const renderer::PyramidShadowOptions options{.resolution = 128};
    const scenes::Snapshot last = scenes::take_snapshot(scene, moment(times.back()));
    PyramidShadows moving(moving_scene(scene, last, moment(times.back()), bounds), options);
    std::vector<std::uint8_t> before;
    int changes = 0;
    for (const double seconds : times) {
        moving.move_to(seconds);
        const auto frame = moving.render(view, only_image).image.rgba;
        const scenes::Snapshot then = scenes::take_snapshot(scene, moment(seconds));
        PyramidShadows fresh(moving_scene(scene, then, moment(seconds), bounds), options);
        EXPECT_TRUE(frame == fresh.render(view, only_image).image.rgba) << "at " << seconds;
        changes += frame == before ? 0 : 1;
        before = frame;
    }
    return changes;
}

TEST_F(PyramidPictures, AFrameOfAMovingSceneIsThatOfARendererMadeThen) {
    scenes::Scene scene = moving_zoo(7);
    scenes::add_ground(scene, scenes::bounds_over_animation(scene, moment(0.0), 8.0));
    EXPECT_EQ(expect_fresh_frames(scene, scenes::bounds_over_animation(scene, moment(0.0), 8.0),
                                  {0.0, 0.4, 1.9, 1.1, 0.4}),
              5);
}

TEST_F(PyramidPictures, SoIsOneThatTheCpuHasToMove) {
    // As in moving_surface_test: at some of these times the triangle reaches the grid from far outside.
    scenes::Scene scene = sliding_triangle(-16.0F);
    scene.meshes[0].primitives[0].positions[1].x = 9.0F;
    const scenes::Bounds bounds{glm::dvec3(0.0), glm::dvec3(1.0)};
    const voxelizer::Grid grid = voxelizer::grid_around(bounds, 128);
    voxelizer::MovingSurface surface(scene, moment(0.0), grid);
    int on_cpu = 0;
    const std::vector<double> times = {0.0, 0.4, 0.9, 1.05, 1.15, 0.4};
    for (const double seconds : times) {
        surface.move_to(seconds);
        on_cpu += surface.was_on_cpu() ? 1 : 0;
    }
    EXPECT_GT(on_cpu, 0);
    EXPECT_LT(on_cpu, int(times.size()));
    scenes::add_ground(scene, bounds);
    EXPECT_GE(expect_fresh_frames(scene, bounds, times), 3);
}

TEST_F(PyramidPictures, MovingTakesNoMoreMemoryFromFrameToFrame) {
    scenes::Scene scene = moving_zoo(3);
    const scenes::Bounds bounds = scenes::bounds_over_animation(scene, moment(0.0), 8.0);
    const View view = view_of(bounds, 64, 48, 2);
    const scenes::Snapshot first = scenes::take_snapshot(scene, moment(0.0));
    PyramidShadows moving(moving_scene(scene, first, moment(0.0), bounds), {.resolution = 256});
    const auto frame = [&](int i) {
        moving.move_to(0.05 * (i % 40));
        (void)moving.render(view);
    };
    for (int i = 0; i < 10; ++i)
        frame(i);
    const double before = resident_mib();
    for (int i = 0; i < 40; ++i)
        frame(i);
    // One pyramid that leaks per frame would be 100 MiB.
    EXPECT_LT(resident_mib(), before + 16.0);
    moving.move_to(0.0);
    const renderer::ShadowTimes times = moving.render(view).times;
    EXPECT_GT(times.pyramid_bytes, std::size_t(2) << 20U);
    EXPECT_GT(times.move_ms, 0.0);
    EXPECT_GT(times.voxelize_ms, 0.0);
    EXPECT_GT(times.pyramid_ms, 0.0);
    EXPECT_GT(times.trace_ms, 0.0);
    EXPECT_TRUE(times.has_prepared);
}

#ifdef CAIRN_SCENE_DATA
TEST_F(PyramidPictures, RealScenesThatMoveAreNearEmbreeAtEveryFrame) {
    for (const char* const name : {"CesiumMan.glb", "Fox.glb"}) {
        scenes::Scene scene = scenes::load(std::string(CAIRN_SCENE_DATA "/gltf/") + name);
        scenes::When when = moment(0.0);
        // The ground receives shadows outside the grid too.
        const scenes::Bounds bounds = scenes::bounds_over_animation(scene, when, 30.0);
        scenes::add_ground(scene, bounds);
        const View view = view_of(bounds, 160, 120, 32);
        const scenes::Snapshot first = scenes::take_snapshot(scene, when);
        PyramidShadows moving(moving_scene(scene, first, when, bounds), {.resolution = 512});
        const scenes::NodeSelection all(scene.nodes.size(), true);
        const std::vector<double> times = scenes::frame_times(scene, when, 30.0);
        for (const double part : {0.1, 0.5, 0.8}) {
            when.seconds = times[std::size_t(part * double(times.size()))];
            moving.move_to(when.seconds);
            const auto shares = moving.render(view, only_light).light.shares;
            const scenes::Snapshot snapshot = scenes::take_snapshot(scene, when);
            const reference::ImageTracer tracer(scene, snapshot);
            const reference::ShadowQuestion question{
                scene, snapshot, all, view.camera, view.light, view.size.width, view.size.height};
            const auto receivers = reference::shadow_receivers(tracer, question);
            const auto truth = reference::soft_shares(tracer, question, receivers,
                                                      {.standard_error = 1.0 / 256, .least_samples = 64})
                                   .shares;
            const auto error = reference::shadow_error(shares, truth);
            RecordProperty(fmt::format("{}_{}", name, part),
                           fmt::format("{} shadowed of {}, {:.4f} wrong, rmse {:.4f}", error.shadowed,
                                       error.pixels, error.disagreement(), error.rmse()));
            EXPECT_GT(error.shadowed, 100U) << name << " at " << when.seconds;
            EXPECT_LT(error.rmse(), 0.06) << name << " at " << when.seconds;
            EXPECT_LT(error.disagreement(), 0.02) << name << " at " << when.seconds;
        }
    }
}
#endif

}  // namespace
}  // namespace cairn::test
