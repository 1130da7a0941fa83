// Colours of meshes that are rasterized beside voxels: means over what a pixel sees of a texture.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_mix_pictures.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/textured_scene.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::Mix;

class MeshColor : public GlTest {};

scenes::Scene floor_of(int side, std::vector<std::uint8_t> rgba, scenes::AlphaMode mode, float per_length) {
    scenes::Scene scene = triangles(quad({-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}));
    paint_from_above(scene, scene.meshes[0].primitives[0], side, std::move(rgba), mode, per_length);
    return scene;
}

/// The picture of a mesh alone.
Image picture_of(const scenes::Scene& mesh, const View& view) {
    const scenes::Scene far_away = colored(quad({90, 0, 90}, {90, 0, 91}, {91, 0, 91}, {91, 0, 90}), red);
    Renderer renderer = voxels_of(far_away, 64);
    renderer.set_mix({.meshes = raster(mesh), .voxels_hidden = true});
    return renderer.render(view).image;
}

TEST_F(MeshColor, CheckerboardFinerThanPixelsIsOneTone) {
    const scenes::Scene floor =
        floor_of(64, checkerboard(64, opaque_white, opaque_black), scenes::AlphaMode::opaque, 16.0F);
    // From above, at an angle, and at a low angle, where pixels are many times longer than wide.
    for (const glm::dvec3& eye : {glm::dvec3(0.0, 5.0, 0.01), {1.5, 3.0, 3.5}, {0.5, 0.3, 3.0}}) {
        const Image image = picture_of(floor, flat_view(eye, {0.0, 0.0, 0.0}));
        int seen = 0;
        for (int y = 1; y < image.height - 1; ++y) {
            for (int x = 1; x < image.width - 1; ++x) {
                if (at(image, x, y).a != 255) continue;
                ++seen;
                // Half the light, in sRGB.
                ASSERT_NEAR(at(image, x, y).g, 188, 3)
                    << fmt::format("pixel ({}, {}) from {} {} {}", x, y, eye.x, eye.y, eye.z);
            }
        }
        EXPECT_GT(seen, 1000);
    }
}

TEST_F(MeshColor, TexelsLargerThanPixelsStaySharp) {
    const scenes::Scene floor =
        floor_of(4, checkerboard(4, opaque_white, opaque_black), scenes::AlphaMode::opaque, 0.25F);
    const Image image = picture_of(floor, flat_view({0.0, 5.0, 0.01}, {0.0, 0.0, 0.0}));
    int white = 0;
    int black = 0;
    int between = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (at(image, x, y).a != 255) continue;
            const int tone = at(image, x, y).g;
            ++(tone > 250 ? white : tone < 5 ? black : between);
        }
    }
    EXPECT_NEAR(double(white) / black, 1.0, 0.05);
    EXPECT_LT(between, (white + black) / 8) << "edges of texels are a pixel wide";
}

TEST_F(MeshColor, ColoursThatAMaskHidesAreNowhere) {
    for (const float per_length : {0.25F, 1.0F, 4.0F, 16.0F}) {
        const scenes::Scene floor =
            floor_of(16, checkerboard(16, kept_green, hidden_magenta), scenes::AlphaMode::mask, per_length);
        const Image image = picture_of(floor, flat_view({1.5, 3.0, 3.5}, {0.0, 0.0, 0.0}));
        int seen = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const glm::ivec4 pixel = at(image, x, y);
                if (pixel.a != 255) continue;
                ++seen;
                ASSERT_TRUE(pixel.r <= 1 && pixel.b <= 1)
                    << fmt::format("pixel ({}, {}): {} {} {}", x, y, pixel.r, pixel.g, pixel.b);
            }
        }
        EXPECT_GT(seen, 1000);
    }
}

}  // namespace
}  // namespace cairn::test
