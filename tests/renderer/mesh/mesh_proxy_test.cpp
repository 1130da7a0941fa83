// Proxies: meshes that bound the space where voxels show.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reference/image.h"
#include "renderer/mesh/mix.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_mix_pictures.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"

namespace cairn::test {
namespace {

class MeshProxy : public GlTest {};

TEST_F(MeshProxy, AProxyAroundEverythingChangesNoPixel) {
    const scenes::Scene box = colored(box_corners({-9, -9, -9}, {9, 9, 9}), red);
    const scenes::Scene scene = ball_over_floor();
    for (const glm::dvec3& eye :
         {glm::dvec3(2.1, 2.4, 4.3), glm::dvec3(30.0, 20.0, 25.0), glm::dvec3(0.1, 1.3, 0.0)}) {
        View view = flat_view(eye, {0.0, 0.9, 0.0});
        view.shadow.kind = renderer::ShadowQuality::Kind::hard;
        view.light.ambient = 0.25F;
        Renderer renderer = voxels_of(scene, 128);
        const renderer::Frame without = renderer.render(view);
        EXPECT_LE(without.statistics.rays_launched, 155U * 115U);
        EXPECT_GT(without.statistics.rays_launched, 0U);
        renderer.set_mix({.proxy = raster(box)});
        const renderer::Frame with = renderer.render(view);
        EXPECT_EQ(others(with.image, without.image, 0), 0) << "eye " << eye.x;
        EXPECT_GT(with.statistics.rays_launched, 0U);
    }
}

TEST_F(MeshProxy, OnlyPixelsOfTheProxyLaunchRays) {
    // A box beside the scene: its pixels launch rays, which meet nothing, and nothing is produced.
    const scenes::Scene box = colored(box_corners({2.2F, 0.5F, 0.5F}, {2.9F, 1.4F, 1.1F}), red);
    const std::vector<WorldTriangle> triangles = world_triangles(scenes::take_snapshot(box));
    const View view = flat_view({1.1, 1.4, 6.3}, {0.9, 1.0, 0.0});
    Renderer renderer = voxels_of(ball_over_floor(), 128);
    renderer.set_mix({.proxy = raster(box)});
    const renderer::Frame image = renderer.render(view);
    const PictureRays rays(view);
    int surely = 0;
    int doubtful = 0;
    for (int y = 0; y < view.size.height; ++y) {
        for (int x = 0; x < view.size.width; ++x) {
            const PixelFaces truth = faces_at(triangles, rays, x, y);
            doubtful += truth.sure ? 0 : 1;
            surely += truth.sure && !truth.faces.empty() ? 1 : 0;
        }
    }
    EXPECT_GT(surely, 200);
    EXPECT_GT(image.statistics.rays_launched, 0U);
    EXPECT_LE(image.statistics.rays_launched, std::uint64_t(surely + doubtful));
    const std::uint64_t produced = image.statistics.bricks_produced;
    renderer.set_mix({});
    const renderer::Frame frame = renderer.render(view);
    EXPECT_LT(produced * 10, frame.statistics.bricks_produced) << "what no ray met was produced";
    for (std::size_t i = 3; i < image.image.rgba.size(); i += 4)
        ASSERT_EQ(image.image.rgba[i], 0) << "pixel " << i / 4;
}

/// If a face of the scene lies in the proxy by more than two voxels, something shows; if all faces lie
/// outside by more than that, nothing shows.
void expect_cut_by(const scenes::Scene& proxy, const View& view, const scenes::Scene& scene, int resolution) {
    Renderer renderer = voxels_of(scene, resolution);
    renderer.set_mix({.proxy = raster(proxy)});
    const optics::Image image = renderer.render(view).image;
    const std::vector<WorldTriangle> scene_faces = world_triangles(scenes::take_snapshot(scene));
    const std::vector<WorldTriangle> proxy_faces = world_triangles(scenes::take_snapshot(proxy));
    const double margin = 2.0 * voxel_side(scene, resolution);
    const PictureRays rays(view);
    int empty = 0;
    int full = 0;
    for (int y = 1; y < view.size.height; y += 2) {
        for (int x = 1; x < view.size.width; x += 2) {
            const PixelFaces span = faces_at(proxy_faces, rays, x, y);
            if (!span.sure) continue;
            double first = 1e30;
            double last = -1e30;
            int backs = 0;
            for (const Face& face : span.faces) {
                first = std::min(first, face.t);
                last = std::max(last, face.t);
                backs += face.cosine > 0.0 ? 1 : -1;
            }
            if (backs > 0) first = 0.0;
            bool inside = false;
            bool outside = true;
            // Voxels beside the ray count as on it; near a silhouette they may lie anywhere between its
            // faces.
            const std::size_t count =
                faces_along(scene_faces, rays.eye, rays.direction({x + 0.5, y + 0.5})).size();
            for (const glm::dvec2 shift : {glm::dvec2(0, 0), glm::dvec2(-3, -3), glm::dvec2(3, -3),
                                           glm::dvec2(-3, 3), glm::dvec2(3, 3)}) {
                const auto direction = rays.direction(glm::dvec2(x + 0.5, y + 0.5) + shift);
                const std::vector<Face> faces = faces_along(scene_faces, rays.eye, direction);
                outside = outside && faces.size() == count;
                for (const Face& face : faces) {
                    const double slack = margin / std::max(std::abs(face.cosine), 0.05);
                    if (shift == glm::dvec2(0, 0))
                        inside = inside || (face.t > first + slack && face.t < last - slack);
                    outside = outside && (face.t < first - slack || face.t > last + slack);
                }
            }
            const int alpha = at(image, x, y).a;
            if (inside) {
                ++full;
                ASSERT_EQ(alpha, 255) << "pixel (" << x << ", " << y << ")";
            } else if (outside) {
                ++empty;
                ASSERT_EQ(alpha, 0) << "pixel (" << x << ", " << y << ")";
            }
        }
    }
    EXPECT_GT(full, 100);
    EXPECT_GT(empty, 100);
}

TEST_F(MeshProxy, AProxyCutsTheVoxelsAtItsFaces) {
    const scenes::Scene scene = ball_over_floor();
    const scenes::Scene box = colored(box_corners({-0.7F, 0.3F, -0.6F}, {1.4F, 1.7F, 0.5F}), red);
    expect_cut_by(box, flat_view({2.1, 2.4, 4.3}, {0.0, 1.0, 0.0}), scene, 256);
    expect_cut_by(box, flat_view({-3.0, -1.4, 1.3}, {0.0, 1.0, 0.0}), scene, 256);
    // The eye inside: only what is behind it, and before its far faces, is cut off.
    const scenes::Scene room = colored(box_corners({-1.3F, -0.6F, -0.2F}, {4.0F, 4.0F, 5.0F}), red);
    expect_cut_by(room, flat_view({2.1, 2.4, 4.3}, {0.0, 1.0, 0.0}), scene, 256);
}

TEST_F(MeshProxy, AProxyShowsTheMiddleOfThreeSheetsAlone) {
    std::vector<glm::vec3> corners;
    for (const float z : {-1.0F, 0.0F, 1.0F}) {
        const std::vector<glm::vec3> one = quad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
        corners.insert(corners.end(), one.begin(), one.end());
    }
    scenes::Scene scene = triangles(corners);
    const glm::u16vec4 colors[] = {{65535, 0, 0, 65535}, {0, 65535, 0, 65535}, {0, 0, 65535, 65535}};
    for (int i = 0; i < 18; ++i)
        scene.meshes[0].primitives[0].colors.push_back(colors[i / 6]);
    const scenes::Scene box = colored(box_corners({-2, -2, -0.5F}, {2, 2, 0.5F}), red);
    Renderer renderer = voxels_of(scene, 128);
    const View view = flat_view({0.0, 0.0, 6.0}, {0.0, 0.0, 0.0}, 64, 64);
    EXPECT_GT(at(renderer.render(view).image, 32, 32).b, 100);
    renderer.set_mix({.proxy = raster(box)});
    const optics::Image image = renderer.render(view).image;
    for (int y = 26; y < 38; ++y) {
        for (int x = 26; x < 38; ++x) {
            const glm::ivec4 pixel = at(image, x, y);
            ASSERT_TRUE(pixel.g > 100 && pixel.r == 0 && pixel.b == 0 && pixel.a == 255)
                << "pixel (" << x << ", " << y << "): " << pixel.r << ' ' << pixel.g << ' ' << pixel.b;
        }
    }
}

}  // namespace
}  // namespace cairn::test
