// Trees of every shape show the same picture.
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/march_twin.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using optics::Image;
using renderer::Renderer;
using renderer::View;

/// A shape, its resolution, and another shape of the same resolution: one dense brick if possible.
struct Pair {
    int n, m, resolution;
    int other_n, other_m;
};

std::string name_of(const ::testing::TestParamInfo<Pair>& pair) {
    return fmt::format("N{}M{}Resolution{}", pair.param.n, pair.param.m, pair.param.resolution);
}

Renderer make_renderer(const scenes::Scene& scene, const Settings& options) {
    return voxel_renderer(scene, scenes::take_snapshot(scene), options);
}

/// A view that shows every voxel at the finest level, whatever the distance.
View finest_view(const scenes::Scene& scene) {
    View view;
    view.size.width = 120;
    view.size.height = 90;
    view.camera = optics::framing_camera(scenes::take_snapshot(scene).bounds,
                                         double(view.size.width) / view.size.height);
    view.detail.pixel_error = 1e-6;
    return view;
}

struct Difference {
    /// Pixels that differ in a channel by more than the threshold.
    std::size_t pixels_over = 0;
    std::string first;
};

Difference compare(const optics::Image& a, const optics::Image& b, int threshold) {
    Difference difference;
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    for (std::size_t pixel = 0; pixel * 4 < a.rgba.size(); ++pixel) {
        int most = 0;
        for (std::size_t k = 4 * pixel; k < 4 * pixel + 4; ++k)
            most = std::max(most, std::abs(int(a.rgba[k]) - int(b.rgba[k])));
        if (most <= threshold || difference.pixels_over++ != 0) continue;
        difference.first = fmt::format("pixel ({}, {}) differs by {}", pixel % std::size_t(a.width),
                                       pixel / std::size_t(a.width), most);
    }
    return difference;
}

class EveryTreeShape : public GlTest, public ::testing::WithParamInterface<Pair> {
protected:
    [[nodiscard]] static Settings options() {
        return {.tree = {.n = GetParam().n, .m = GetParam().m, .max_resolution = GetParam().resolution}};
    }
};

TEST_P(EveryTreeShape, PictureEqualsTheOneOfAnotherShapeWithTheSameVoxels) {
    const scenes::Scene scene = ball_over_floor();
    View view = finest_view(scene);
    Renderer ours = make_renderer(scene, options());
    Renderer other = make_renderer(scene, {.tree = {.n = GetParam().other_n,
                                                    .m = GetParam().other_m,
                                                    .max_resolution = GetParam().resolution}});
    for (const double side : {1.0, -0.6}) {
        const glm::dvec3 away = view.camera.eye - view.camera.target;
        view.camera.eye = view.camera.target + glm::dvec3(side * away.x, away.y, away.z);
        const optics::Image picture = ours.render(view).image;
        const Difference difference = compare(picture, other.render(view).image, 1);
        // Cells of other sizes round at other places: a ray along an edge may take the voxel on its other
        // side.
        EXPECT_LE(difference.pixels_over, picture.rgba.size() / 4 / 2000) << difference.first;
        const renderer::Frame again = ours.render(view);
        EXPECT_EQ(again.statistics.bricks_produced, 0U);
        EXPECT_EQ(picture.rgba, again.image.rgba);
    }
}

class ScarceTreeShape : public EveryTreeShape {};

TEST_P(ScarceTreeShape, PoolFarSmallerThanTheViewEndsWithTheSamePicture) {
    const scenes::Scene scene = ball_over_floor();
    View view = finest_view(scene);
    view.size.width = 40;
    view.size.height = 30;
    Settings tight = options();
    Renderer roomy = make_renderer(scene, tight);
    const optics::Image expected = roomy.render(view).image;
    tight.pools.brick_bytes = renderer::least_packed_bytes(renderer::tree_shape_of(tight.tree), false);
    tight.pools.node_bytes = std::size_t(tight.tree.n * tight.tree.n * tight.tree.n) * 16 * 6;
    Renderer renderer = make_renderer(scene, tight);
    const renderer::Frame frame = renderer.render(view);
    EXPECT_EQ(frame.image.rgba, expected.rgba);
    EXPECT_LE(frame.statistics.brick_bytes_resident, tight.pools.brick_bytes);
}

TEST_P(ScarceTreeShape, PictureAfterManyShortFramesIsThatOfOneLong) {
    const scenes::Scene scene = ball_over_floor();
    View view = finest_view(scene);
    const optics::Image expected = make_renderer(scene, options()).render(view).image;
    Renderer renderer = make_renderer(scene, options());
    for (int frame = 0; frame < 2000; ++frame) {
        const renderer::Frame ours = renderer.render(view, {.budget = Milliseconds(30.0)});
        if (!ours.statistics.converged) continue;
        EXPECT_EQ(ours.image.rgba, expected.rgba);
        return;
    }
    FAIL() << "2000 frames did not end with a whole picture";
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryTreeShape,
                         ::testing::Values(Pair{2, 8, 64, 2, 64}, Pair{2, 16, 64, 2, 64},
                                           Pair{2, 32, 64, 2, 64}, Pair{2, 64, 128, 2, 8},
                                           Pair{4, 8, 32, 2, 32}, Pair{4, 16, 64, 2, 64},
                                           Pair{4, 32, 128, 2, 8}, Pair{4, 64, 256, 4, 16},
                                           Pair{8, 8, 64, 2, 64}, Pair{8, 16, 128, 2, 8},
                                           Pair{8, 32, 256, 4, 16}, Pair{8, 64, 512, 2, 32},
                                           Pair{3, 27, 81, 3, 81}, Pair{3, 81, 243, 3, 27}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Shapes, ScarceTreeShape,
                         ::testing::Values(Pair{4, 8, 32, 2, 32}, Pair{8, 8, 512, 2, 8},
                                           Pair{8, 16, 128, 2, 8}, Pair{3, 27, 81, 3, 81},
                                           Pair{3, 27, 243, 3, 81}, Pair{3, 81, 243, 3, 27}),
                         name_of);

struct TwinShape {
    int n, m, resolution;
};

class TwinOfShape : public GlTest, public ::testing::WithParamInterface<TwinShape> {};

TEST_P(TwinOfShape, PictureEqualsThePlainCpuMarchOfTheSameBits) {
    const scenes::Scene scene = ball_over_floor();
    const auto [n, m, resolution] = GetParam();
    const DenseVoxels voxels = dense_voxels(scene, resolution, n != 3);
    Renderer renderer = make_renderer(scene, {.tree = {.n = n, .m = m, .max_resolution = resolution}});
    const View view = finest_view(scene);
    const optics::Image ours = renderer.render(view).image;
    // As in renderer_test: float against double, where a threshold is crossed.
    const Difference difference = compare(ours, march_dense(voxels, view), 2);
    EXPECT_LE(difference.pixels_over, ours.rgba.size() / 4 / 200) << difference.first;
}

INSTANTIATE_TEST_SUITE_P(Shapes, TwinOfShape,
                         ::testing::Values(TwinShape{8, 8, 64}, TwinShape{3, 27, 27}, TwinShape{3, 27, 81},
                                           TwinShape{3, 81, 81}),
                         [](const auto& shape) {
                             return fmt::format("N{}M{}Resolution{}", shape.param.n, shape.param.m,
                                                shape.param.resolution);
                         });

}  // namespace
}  // namespace cairn::test
