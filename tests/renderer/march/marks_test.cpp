// Rays meet the marks of voxels: none that meets a triangle passes by them, and what they show is as sharp as
// voxels of a quarter of the size.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/image.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::Renderer;
using renderer::View;

class Marks : public GlTest {};

/// A view from somewhere around the scene, near or far, or inside it.
View random_view(const scenes::Bounds& bounds, Random& random, int side) {
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double size = glm::length(bounds.high - bounds.low);
    const auto unit = [&] { return random.unit() - 0.5; };
    const glm::dvec3 away = glm::normalize(glm::dvec3(unit(), unit(), unit()) + 1e-3);
    View view;
    view.size = {side, side};
    view.camera.eye = middle + away * size * (0.1 + 1.2 * random.unit());
    view.camera.target = middle + glm::dvec3(unit(), unit(), unit()) * 0.3 * size;
    view.camera.yfov = 0.3 + 0.8 * random.unit();
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    return view;
}

/// Rays of random views that Embree says meet a triangle; fails at the first that the voxels let through.
void expect_no_ray_through(const scenes::Scene& scene, Renderer& renderer, double pixel_error, int views,
                           std::uint32_t seed, std::uint64_t& rays) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    const reference::ImageTracer truth(scene, snapshot);
    Random random(seed);
    constexpr int side = 880;
    for (int i = 0; i < views; ++i) {
        View view = random_view(snapshot.bounds, random, side);
        view.detail.pixel_error = pixel_error;
        const optics::Image image = renderer.render(view).image;
        const reference::ReferenceImage traced = truth.trace(view.camera, {}, side, side);
        for (std::size_t pixel = 0; pixel < traced.depth.size(); ++pixel) {
            if (!std::isfinite(traced.depth[pixel])) continue;
            ++rays;
            ASSERT_EQ(image.rgba[4 * pixel + 3], 255) << fmt::format(
                "seed {}, view {}, pixel ({}, {}), pixel error {}: the ray meets a triangle at {}", seed, i,
                pixel % side, pixel / side, pixel_error, traced.depth[pixel]);
        }
    }
}

TEST_F(Marks, NoRayThatMeetsATrianglePassesThem) {
    std::uint64_t rays = 0;
    for (const char* name : {"knot", "spheres", "needles", "tree"}) {
        const scenes::Scene scene = scenes::make_builtin(name);
        Renderer renderer =
            voxel_renderer(scene, scenes::take_snapshot(scene), {.tree = {.max_resolution = 256}});
        std::uint32_t seed = 71;
        for (const double pixel_error : {0.5, 16.0}) {
            SCOPED_TRACE(name);
            expect_no_ray_through(scene, renderer, pixel_error, 3, seed++, rays);
            if (HasFatalFailure()) return;
        }
    }
    fmt::print("{} rays\n", rays);
    EXPECT_GT(rays, 10000000U);
}

TEST_F(Marks, AreMetInTheFinestTreeThatRaysCanCount) {
    // Voxels of 2^-19 of the floor, from so near that their marks are wider than pixels.
    const scenes::Scene floor = triangles(quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}));
    const scenes::Snapshot snapshot = scenes::take_snapshot(floor);
    Renderer renderer =
        voxel_renderer(floor, snapshot, {.tree = {.n = 2, .m = 16, .max_resolution = 1 << 19}});
    View view;
    view.size = {48, 32};
    view.camera.eye = {0.300001, 2e-5, 0.100003};
    view.camera.target = {0.3000071, 0.0, 0.100001};
    const optics::Image image = renderer.render(view).image;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        ASSERT_EQ(image.rgba[i], 255) << "pixel " << i / 4;
    try {
        (void)voxel_renderer(floor, snapshot, {.tree = {.n = 2, .m = 16, .max_resolution = 1 << 20}});
        ADD_FAILURE() << "rays cannot count so many marks";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        EXPECT_NE(error.way_out().find("524288"), std::string::npos) << error.way_out();
    }
}

}  // namespace
}  // namespace cairn::test
