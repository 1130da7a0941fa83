#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "reference/image.h"
#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "scenes/load.h"
#include "shaders/interop/mesh.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_mix_pictures.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::Mix;

class MeshMix : public GlTest {};

/// If Embree sees the mesh before the voxelized scene by more than two voxels, and neither ends within two
/// pixels, the picture shows the mesh; and the other way round.
void expect_depth_order(const scenes::Scene& scene, const scenes::Scene& mesh, const View& view,
                        int resolution) {
    Renderer renderer = voxels_of(scene, resolution);
    renderer.set_mix({.meshes = raster(mesh)});
    const optics::Image image = renderer.render(view).image;
    const optics::Camera& camera = view.camera;
    const scenes::Snapshot scene_now = scenes::take_snapshot(scene);
    const scenes::Snapshot mesh_now = scenes::take_snapshot(mesh);
    const auto voxels =
        reference::ImageTracer(scene, scene_now).trace(camera, {}, view.size.width, view.size.height);
    const auto faces =
        reference::ImageTracer(mesh, mesh_now).trace(camera, {}, view.size.width, view.size.height);
    const auto of_mesh = [&](int x, int y) {
        const auto i = std::size_t(y * view.size.width + x);
        return faces.depth[i] < voxels.depth[i];
    };
    const double margin = 2.0 * voxel_side(scene, resolution);
    int shown[2] = {0, 0};
    for (int y = 2; y < view.size.height - 2; ++y) {
        for (int x = 2; x < view.size.width - 2; ++x) {
            const auto i = std::size_t(y * view.size.width + x);
            bool sure = std::abs(double(faces.depth[i]) - double(voxels.depth[i])) > margin;
            for (int dy = -2; dy <= 2; ++dy) {
                for (int dx = -2; dx <= 2; ++dx) {
                    const auto j = std::size_t((y + dy) * view.size.width + x + dx);
                    sure = sure && of_mesh(x + dx, y + dy) == of_mesh(x, y) &&
                           std::isfinite(voxels.depth[i]) == std::isfinite(voxels.depth[j]) &&
                           std::isfinite(faces.depth[i]) == std::isfinite(faces.depth[j]);
                }
            }
            if (!sure || (!std::isfinite(voxels.depth[i]) && !std::isfinite(faces.depth[i]))) continue;
            const glm::ivec4 pixel = at(image, x, y);
            const bool is_red = pixel.r > 2 * pixel.g;
            ++shown[is_red ? 1 : 0];
            ASSERT_EQ(is_red, of_mesh(x, y)) << "pixel (" << x << ", " << y << "): mesh at " << faces.depth[i]
                                             << ", voxelized surface at " << voxels.depth[i];
            ASSERT_EQ(pixel.a, 255) << "pixel (" << x << ", " << y << ")";
        }
    }
    EXPECT_GT(shown[0], 500) << "hardly any voxels were seen";
    EXPECT_GT(shown[1], 500) << "hardly any mesh was seen";
}

TEST_F(MeshMix, WhatIsNearerShowsWhereAMeshCrossesTheVoxels) {
    const scenes::Scene tilted =
        colored(quad({-3, 0.2F, 3}, {3, 1.6F, 3}, {3, 2.2F, -3}, {-3, 0.8F, -3}), red);
    expect_depth_order(ball_over_floor(), tilted, flat_view({2.1, 3.4, 4.3}, {0.0, 1.0, 0.0}), 256);
    const scenes::Scene box = colored(box_corners({-1.6F, 0.4F, -0.3F}, {1.7F, 1.9F, 0.4F}), red);
    expect_depth_order(ball_over_floor(), box, flat_view({2.1, 2.4, 4.3}, {0.0, 1.0, 0.0}), 256);
    expect_depth_order(ball_over_floor(), box, flat_view({-3.1, 0.7, 2.3}, {0.0, 1.0, 0.0}), 256);
}

TEST_F(MeshMix, WhatIsNearerShowsFromWithinTheMesh) {
    // The eye is inside a box that reaches around it and cuts the scene: its walls are behind some voxels,
    // before others.
    const scenes::Scene box = colored(box_corners({-1.3F, -0.6F, -0.9F}, {4.0F, 4.0F, 5.0F}), red);
    expect_depth_order(ball_over_floor(), box, flat_view({2.1, 2.4, 4.3}, {0.0, 1.0, 0.0}), 256);
}

TEST_F(MeshMix, AKnotAndSpheresInterlaced) {
    scenes::Scene spheres = scenes::make_builtin("spheres");
    for (scenes::Material& material : spheres.materials)
        material.base_color = red;
    scenes::Scene knot = scenes::make_builtin("knot");
    for (scenes::Material& material : knot.materials)
        material.base_color = glm::vec4(0.5F, 0.6F, 0.7F, 1.0F);
    View view = flat_view({1.0, 2.0, 5.0}, {0.0, 0.0, 0.0}, 203, 149);
    expect_depth_order(knot, spheres, view, 512);
}

TEST_F(MeshMix, VoxelsCoverAMeshBehindThemAsTheyCoverABackground) {
    // Silhouettes are translucent where one of two mips shows a mark and the other does not: a mesh of one
    // colour behind everything must look like a background of that colour. With shadow rays from the voxels
    // and from the mesh behind them, which must not meet anything else.
    const scenes::Scene ball = ball_over_floor();
    const glm::vec3 color(0.1F, 0.5F, 0.3F);
    const scenes::Scene wall =
        colored(quad({-90, -90, -20}, {90, -90, -20}, {90, 90, -20}, {-90, 90, -20}), glm::vec4(color, 1.0F));
    View view = flat_view({0.0, 1.2, 6.0}, {0.0, 1.0, 0.0});
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    view.light.ambient = 0.25F;
    view.light.towards = glm::normalize(glm::dvec3(1.0, 0.4, 0.05));  // shadows fall far to the left
    view.detail = {.kind = renderer::LevelOfDetail::Kind::blended, .pixel_error = 3.0};
    Renderer renderer = voxel_renderer(
        ball, scenes::take_snapshot(ball),
        {.tree = {.max_resolution = 128, .mips = true, .geometry = renderer::VoxelGeometry::marks}});
    renderer.set_mix({.meshes = raster(wall), .mesh_shadows = true});
    const optics::Image with_wall = renderer.render(view).image;
    renderer.set_mix({});
    const double facing = glm::dot(view.light.towards, glm::dvec3(0.0, 0.0, 1.0));
    view.background = color * float(0.25 * 0.75 + 0.75 * facing);
    const optics::Image with_background = renderer.render(view).image;
    int translucent = 0;
    for (std::size_t i = 3; i < with_background.rgba.size(); i += 4) {
        translucent += with_background.rgba[i] > 20 && with_background.rgba[i] < 235 ? 1 : 0;
        ASSERT_EQ(with_wall.rgba[i], 255);
    }
    EXPECT_GT(translucent, 20) << "no silhouette was translucent";
    EXPECT_EQ(others(with_wall, with_background, 1, false), 0);
}

TEST_F(MeshMix, ShadowOfVoxelsOnAMeshLiesWhereGeometryPutsIt) {
    // As in RendererTest.ShadowOfASquareLiesWhereGeometryPutsIt, but the floor is a mesh and reaches out of
    // the voxels.
    scenes::Scene square = colored(
        quad({-0.5F, 1, -0.5F}, {-0.5F, 1, 0.5F}, {0.5F, 1, 0.5F}, {0.5F, 1, -0.5F}), glm::vec4(1.0F));
    const scenes::Scene floor =
        colored(quad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}), glm::vec4(1.0F));
    View view = flat_view({0.0, 0.9, 3.2}, {0.0, 0.0, 0.0}, 300, 300);
    view.detail.pixel_error = 1.0;
    view.shadow.kind = renderer::ShadowQuality::Kind::hard;
    view.light.towards = {0.0, 1.0, 0.0};
    view.light.ambient = 0.0F;
    Renderer renderer = voxels_of(square, 512);
    renderer.set_mix({.meshes = raster(floor), .mesh_shadows = true});
    const optics::Image image = renderer.render(view).image;
    const PictureRays rays(view);
    int dark = 0;
    int lit = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const glm::dvec3 direction = rays.direction({x + 0.5, y + 0.5});
            if (direction.y > -0.15) continue;  // the square itself, and what is far away
            const glm::dvec3 point = rays.eye - direction * (rays.eye.y / direction.y);
            const double edge = std::max(std::abs(point.x), std::abs(point.z)) - 0.5;
            if (std::abs(edge) < 0.02) continue;
            const int value = at(image, x, y).r;
            ++(edge < 0.0 ? dark : lit);
            ASSERT_EQ(value, edge < 0.0 ? 0 : 255) << "pixel (" << x << ", " << y << "), edge at " << edge;
        }
    }
    EXPECT_GT(dark, 500);
    EXPECT_GT(lit, 2000);
}

/// Share of the mesh's lit pixels that its own voxels darken, or that differ from Embree.
struct Shading {
    int lit = 0;
    int darkened = 0;
    int shadowed = 0;
    int leaks = 0;
};
Shading shade_own_voxels(const scenes::Scene& scene, int resolution, bool are_voxelized) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view;
    view.size.width = 155;
    view.size.height = 115;
    view.camera = optics::framing_camera(snapshot.bounds, 155.0 / 115.0);
    view.detail.pixel_error = 1e-6;
    view.light.ambient = 0.0F;
    Renderer renderer = voxels_of(scene, resolution);
    // A proxy that is nowhere: no voxel is seen, and all cast their shadows.
    const scenes::Scene nowhere = colored(quad({0, 900, 0}, {1, 900, 0}, {1, 901, 0}, {0, 901, 0}), red);
    renderer.set_mix({.meshes = raster(scene),
                      .mesh_shadows = true,
                      .meshes_are_voxelized = are_voxelized,
                      .proxy = raster(nowhere)});
    const optics::Image image = renderer.render(view).image;
    const auto truth = reference::ImageTracer(scene, snapshot)
                           .trace({view.camera.eye, view.camera.target, view.camera.up, view.camera.yfov},
                                  {.towards = view.light.towards}, view.size.width, view.size.height);
    const std::vector<WorldTriangle> triangles = world_triangles(snapshot);
    const glm::dvec3 light = glm::normalize(view.light.towards);
    const PictureRays rays(view);
    Shading out;
    for (std::size_t i = 0; i < truth.depth.size(); ++i) {
        if (truth.primitive[i] == reference::ReferenceImage::no_primitive) continue;
        const auto& [a, b, c] = triangles[truth.primitive[i]].corners;
        glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const int width = view.size.width;
        const glm::dvec3 direction =
            rays.direction({double(int(i) % width) + 0.5, double(int(i) / width) + 0.5});
        if (glm::dot(normal, direction) > 0.0) normal = -normal;
        if (glm::dot(normal, light) < 0.15) continue;  // the light grazes it or comes from behind
        const bool is_dark = image.rgba[4 * i] == 0;
        ++(truth.lit[i] != 0 ? out.lit : out.shadowed);
        if (truth.lit[i] != 0 && is_dark) ++out.darkened;
        if (truth.lit[i] == 0 && !is_dark) ++out.leaks;
    }
    return out;
}

TEST_F(MeshMix, AVoxelizedMeshDoesNotShadowItself) {
    for (const int resolution : {128, 512}) {
        const Shading own = shade_own_voxels(ball_over_floor(), resolution, true);
        const Shading foreign = shade_own_voxels(ball_over_floor(), resolution, false);
        RecordProperty(fmt::format("at_{}", resolution),
                       fmt::format("own: {} of {} lit darkened, {} of {} shadowed leak; foreign: {} darkened",
                                   own.darkened, own.lit, own.leaks, own.shadowed, foreign.darkened));
        EXPECT_LE(own.darkened, own.lit / 25) << "resolution " << resolution;
        EXPECT_LE(own.leaks, own.shadowed / 25) << "resolution " << resolution;
        EXPECT_GT(foreign.darkened, own.lit / 2) << "the test could not fail";
    }
}

TEST_F(MeshMix, AnAlphaMaskCutsTheMeshWhereTheTextureSaysSo) {
    // Half a sheet before a white one.
    scenes::Scene half = sheet(red);
    half.images.push_back({"halves", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}});
    half.textures.push_back({0, scenes::Wrap::clamp_to_edge, scenes::Wrap::clamp_to_edge});
    half.materials[0].texture = 0;
    half.materials[0].alpha_mode = scenes::AlphaMode::mask;
    half.nodes[0].trs.translation = {0.0, 0.5, 0.0};
    scenes::Primitive& square = half.meshes[0].primitives[0];
    for (const glm::vec3& p : square.positions)
        square.texcoords.emplace_back(0.5F + 0.5F * p.x, 0.5F);
    Renderer renderer = voxels_of(sheet(glm::vec4(1.0F)), 64);
    renderer.set_mix({.meshes = raster(half)});
    View view = flat_view({0.0, 3.0, 0.0}, {0.0, 0.0, 0.0}, 64, 64);
    view.camera.up = {0.0, 0.0, -1.0};
    const optics::Image image = renderer.render(view).image;
    const double pixels = 64.0 / (2.0 * std::tan(0.5 * view.camera.yfov));  // across a unit at distance 1
    for (int x = 0; x < 64; ++x) {
        const double on_mesh = (x + 0.5 - 32.0) / pixels * 2.5;
        const double on_voxels = (x + 0.5 - 32.0) / pixels * 3.0;
        if (std::abs(on_mesh) < 0.06 || std::abs(on_mesh + 1.0) < 0.06 || std::abs(on_voxels - 1.0) < 0.08)
            continue;
        const glm::ivec4 pixel = at(image, x, 32);
        if (on_mesh > -1.0 && on_mesh < 0.0) {
            EXPECT_GT(pixel.r, 4 * pixel.g) << "x = " << on_mesh;
        } else if (on_voxels < 1.0 && on_mesh > 0.0) {
            EXPECT_EQ(pixel.g, 255) << "x = " << on_mesh;
        } else {
            EXPECT_EQ(pixel.a, 0) << "x = " << on_mesh;
        }
    }
}

TEST_F(MeshMix, ColoursOfAMeshAreThoseOfItsVoxels) {
    // Faces that the light meets alike, far from their edges: the mesh shows what its voxels show.
    const scenes::Scene scene = scenes::make_builtin("cornell");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    View view;
    view.size.width = view.size.height = 96;
    view.camera = optics::framing_camera(snapshot.bounds, 1.0);
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    Renderer renderer = voxels_of(scene, 512);
    const optics::Image voxels = renderer.render(view).image;
    const scenes::Scene nowhere = colored(quad({0, 900, 0}, {1, 900, 0}, {1, 901, 0}, {0, 901, 0}), red);
    renderer.set_mix({.meshes = raster(scene), .proxy = raster(nowhere)});
    const optics::Image mesh = renderer.render(view).image;
    EXPECT_LE(others(voxels, mesh, 6), 96 * 96 / 12) << "more than edges differ";
}

/// A picture with everything: two receivers per pixel, a proxy that cuts, sizes that blocks of rays do not
/// divide.
struct Everything {
    Everything() : view(flat_view({2.1, 2.4, 4.3}, {0.0, 1.0, 0.0}, 97, 61)) {
        view.shadow.kind = renderer::ShadowQuality::Kind::hard;
        view.light.ambient = 0.25F;
        view.detail.pixel_error = 1.0;
        mix = {.meshes =
                   raster(colored(quad({-4, -0.3F, 4}, {4, -0.3F, 4}, {4, 0.5F, -4}, {-4, 0.5F, -4}), red)),
               .mesh_shadows = true,
               .proxy = raster(colored(box_corners({-0.7F, -0.3F, -1.6F}, {1.4F, 2.7F, 1.5F}), red))};
    }
    [[nodiscard]] Renderer renderer(std::size_t brick_pool_bytes = 64U << 20U) const {
        const scenes::Scene scene = ball_over_floor();
        Renderer out =
            voxel_renderer(scene, scenes::take_snapshot(scene),
                           {.tree = {.max_resolution = 256}, .pools = {.brick_bytes = brick_pool_bytes}});
        out.set_mix(mix);
        return out;
    }
    View view;
    Mix mix;
};

TEST_F(MeshMix, RowsRenderedApartAreThoseOfTheWholePicture) {
    const Everything all;
    const optics::Image whole = all.renderer().render(all.view).image;
    Renderer renderer = all.renderer();
    for (const renderer::Rows rows : {renderer::Rows{0, 7}, renderer::Rows{7, 30}, renderer::Rows{37, 24}}) {
        const optics::Image part = renderer.render(all.view, {.rows = rows}).image;
        ASSERT_EQ(part.height, rows.count);
        const auto first = whole.rgba.begin() + std::ptrdiff_t(rows.first) * whole.width * 4;
        EXPECT_TRUE(std::equal(part.rgba.begin(), part.rgba.end(), first)) << "rows from " << rows.first;
    }
}

TEST_F(MeshMix, RowsFromTwoStripsOfAMeshAreThoseOfEachAlone) {
    Everything all;
    all.view.size.width = 4096;
    all.view.size.height = 2048;
    const int border = renderer::MeshRasterLimits().strip_pixels / all.view.size.width;
    ASSERT_LT(border, all.view.size.height);
    all.mix.proxy = nullptr;
    Renderer renderer = all.renderer();
    const optics::Image both = renderer.render(all.view, {.rows = renderer::Rows{border - 1, 2}}).image;
    ASSERT_EQ(both.height, 2);
    int shown = 0;
    for (const int row : {1, 0}) {
        const optics::Image one =
            renderer.render(all.view, {.rows = renderer::Rows{border - 1 + row, 1}}).image;
        const auto first = both.rgba.begin() + std::ptrdiff_t(row) * both.width * 4;
        EXPECT_TRUE(std::equal(one.rgba.begin(), one.rgba.end(), first)) << "row " << border - 1 + row;
        for (std::size_t i = 0; i < one.rgba.size(); i += 4)
            shown += one.rgba[i] > 2 * one.rgba[i + 1] ? 1 : 0;
    }
    EXPECT_GT(shown, 1000) << "hardly any mesh was seen";
}

TEST_F(MeshMix, FramesWithinABudgetComeToTheSamePicture) {
    const Everything all;
    const optics::Image whole = all.renderer().render(all.view).image;
    Renderer renderer = all.renderer();
    renderer::Frame refined = renderer.render(all.view, {.budget = Milliseconds(0.0)});
    int frames = 1;
    for (; !refined.statistics.converged && frames < 200; ++frames)
        refined = renderer.render(all.view, {.budget = Milliseconds(5.0)});
    EXPECT_TRUE(refined.statistics.converged) << frames << " frames";
    EXPECT_EQ(others(refined.image, whole, 0), 0);
}

TEST_F(MeshMix, APoolFarSmallerThanTheViewEndsWithTheSamePicture) {
    const Everything all;
    const optics::Image expected = all.renderer().render(all.view).image;
    Renderer tight = all.renderer(86000);  // little more than a full brick
    const renderer::Frame frame = tight.render(all.view);
    EXPECT_EQ(others(frame.image, expected, 0), 0);
    EXPECT_GT(frame.statistics.bricks_evicted, 0U);
}

TEST_F(MeshMix, TakenAwayItLeavesThePictureOfVoxelsAlone) {
    const Everything all;
    Renderer renderer = all.renderer();
    (void)renderer.render(all.view);
    renderer.set_mix({});
    const optics::Image after = renderer.render(all.view).image;
    Renderer fresh = all.renderer();
    fresh.set_mix({});
    EXPECT_EQ(others(after, fresh.render(all.view).image, 0), 0);
    EXPECT_NE(after.rgba, all.renderer().render(all.view).image.rgba);
}

TEST_F(MeshMix, AMillionUnitsFromTheOriginShowsTheSame) {
    const Everything here;
    const optics::Image expected = here.renderer().render(here.view).image;
    const glm::dvec3 away(1e6, -3e6, 2e6);
    const auto moved = [&](scenes::Scene scene) {
        scene.nodes[0].trs.translation += away;
        return scene;
    };
    const scenes::Scene scene = moved(ball_over_floor());
    Renderer renderer =
        voxel_renderer(scene, scenes::take_snapshot(scene), {.tree = {.max_resolution = 256}});
    renderer.set_mix(
        {.meshes =
             raster(moved(colored(quad({-4, -0.3F, 4}, {4, -0.3F, 4}, {4, 0.5F, -4}, {-4, 0.5F, -4}), red))),
         .mesh_shadows = true,
         .proxy = raster(moved(colored(box_corners({-0.7F, -0.3F, -1.6F}, {1.4F, 2.7F, 1.5F}), red)))});
    View view = here.view;
    view.camera.eye += away;
    view.camera.target += away;
    EXPECT_LE(others(renderer.render(view).image, expected, 2), 97 * 61 / 100);
}

TEST(MeshMixContexts, OsmesaAndEglShowTheSame) {
    std::vector<optics::Image> pictures;
    for (const gl::ContextKind kind : {gl::ContextKind::osmesa, gl::ContextKind::egl}) {
        std::unique_ptr<gl::Context> context;
        try {
            context = gl::create_context({.kind = kind});
        } catch (const Error& error) {  // newer distributions have no OSMesa
            GTEST_SKIP() << "only one kind of context here: " << error.what();
        }
        const Everything all;
        pictures.push_back(all.renderer().render(all.view).image);
    }
    // Drivers may round a vertex to another 256th of a pixel, which shows at edges alone.
    EXPECT_LE(others(pictures[0], pictures[1], 2), 97 * 61 / 100);
}

}  // namespace
}  // namespace cairn::test
