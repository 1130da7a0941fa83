// Several samples per pixel, beside the area of each pixel that an edge leaves, and beside their mean made by
// hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "optics/srgb.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "renderer/shadow_renderer.h"
#include "scenes/load.h"
#include "scenes/snapshot.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/mesh_mix_pictures.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {
namespace {

using renderer::Renderer;
using renderer::View;

TEST(SamplePlaces, OfAPowerOfTwoFillEveryWayOfCuttingThePixelInThatManyParts) {
    EXPECT_EQ(renderer::sample_place(0, 1), glm::dvec2(0.5));
    for (int bits = 1; bits <= 8; ++bits) {
        const int count = 1 << bits;
        for (int columns = 1; columns <= count; columns *= 2) {
            std::set<int> parts;
            for (int i = 0; i < count; ++i) {
                const glm::dvec2 place = renderer::sample_place(i, count);
                parts.insert(int(place.x * columns) + columns * int(place.y * (count / columns)));
            }
            EXPECT_EQ(int(parts.size()), count) << count << " samples, " << columns << " columns";
        }
    }
}

TEST(SamplePlaces, OfEveryNumberLieInThePixelAroundItsMiddle) {
    for (int count = 1; count <= renderer::MAX_SAMPLES; ++count) {
        glm::dvec2 sum(0.0);
        for (int i = 0; i < count; ++i) {
            const glm::dvec2 place = renderer::sample_place(i, count);
            sum += place;
            EXPECT_TRUE(place.x >= 0.0 && place.x < 1.0 && place.y >= 0.0 && place.y < 1.0)
                << i << " of " << count << ": " << place.x << ", " << place.y;
        }
        EXPECT_NEAR(sum.x / count, 0.5, 1e-9) << count;
        EXPECT_NEAR(sum.y / count, 0.5, 1e-9) << count;
    }
}

class Samples : public GlTest {
protected:
    static constexpr int side = 64;
    static constexpr double distance = 2.0;

    /// A half plane across the view, behind a slanted edge from `first` to `second`.
    const glm::vec3 first_{-0.9F, -3.0F, 0.0F};
    const glm::vec3 second_{0.6F, 3.0F, 0.0F};
    scenes::Scene half_plane_ = triangles(quad(first_, second_, {-6.0F, 3.0F, 0.0F}, {-6.0F, -3.0F, 0.0F}));

    static View view() {
        View view;
        view.size = {side, side};
        view.camera.eye = {0.0, 0.0, distance};
        view.camera.target = {0.0, 0.0, 0.0};
        view.shadow.kind = renderer::ShadowQuality::Kind::none;
        view.detail.pixel_error = 0.02;
        return view;
    }

    /// The share of a pixel that the half plane covers.
    [[nodiscard]] double covered(int x, int y) const {
        const double half = distance * std::tan(0.5 * view().camera.yfov);
        const auto in_pixels = [&](const glm::vec3& p) {
            return glm::dvec2(1.0 + double(p.x) / half, 1.0 - double(p.y) / half) * (0.5 * side);
        };
        const glm::dvec2 from = in_pixels(first_);
        const glm::dvec2 along = in_pixels(second_) - from;
        const auto beside = [&](const glm::dvec2& p) {
            return along.x * (p.y - from.y) - along.y * (p.x - from.x);
        };
        // What is left of the pixel's square, cut at the edge.
        const std::array<glm::dvec2, 4> square = {{{x, y}, {x + 1.0, y}, {x + 1.0, y + 1.0}, {x, y + 1.0}}};
        std::vector<glm::dvec2> left;
        const double inside = beside(in_pixels({-6.0F, 0.0F, 0.0F}));
        for (std::size_t i = 0; i < square.size(); ++i) {
            const glm::dvec2& a = square[i];
            const glm::dvec2& b = square[(i + 1) % square.size()];
            const double at_a = beside(a) * inside;
            const double at_b = beside(b) * inside;
            if (at_a >= 0.0) left.push_back(a);
            if (at_a * at_b < 0.0) left.push_back(a + (b - a) * (at_a / (at_a - at_b)));
        }
        double twice_area = 0.0;
        for (std::size_t i = 0; i < left.size(); ++i) {
            const glm::dvec2& a = left[i];
            const glm::dvec2& b = left[(i + 1) % left.size()];
            twice_area += a.x * b.y - a.y * b.x;
        }
        return 0.5 * std::abs(twice_area);
    }

    struct EdgeError {
        double mean = 0.0;  ///< of the alphas of the pixels that the edge crosses, less what it leaves there
        double mean_size = 0.0;  ///< of the differences' absolute values
    };
    [[nodiscard]] EdgeError edge_error(const optics::Image& image) const {
        EdgeError error;
        int count = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double truth = covered(x, y);
                const double alpha = image.rgba[std::size_t(4 * (y * side + x) + 3)] / 255.0;
                if (truth == 0.0 || truth == 1.0) {
                    EXPECT_NEAR(alpha, truth, 0.3) << x << ", " << y;  // a mark may reach over the edge
                    continue;
                }
                error.mean += alpha - truth;
                error.mean_size += std::abs(alpha - truth);
                ++count;
            }
        }
        EXPECT_GT(count, side);
        error.mean /= count;
        error.mean_size /= count;
        return error;
    }

    void expect_less_with_each(Renderer& renderer, double last) const {
        double before = 1.0;
        for (const int samples : {1, 4, 16, 64}) {
            View sampled = view();
            sampled.samples = samples;
            const EdgeError error = edge_error(renderer.render(sampled).image);
            fmt::print("{} samples: {:.4f}, mean {:.4f}\n", samples, error.mean_size, error.mean);
            EXPECT_LT(error.mean_size, 0.55 * before) << samples;
            before = error.mean_size;
        }
        EXPECT_LT(before, last);
    }
};

TEST_F(Samples, OfVoxelsComeToTheAreaThatAnEdgeLeaves) {
    Renderer renderer = voxel_renderer(half_plane_, scenes::take_snapshot(half_plane_));
    expect_less_with_each(renderer, 0.03);
}

TEST_F(Samples, OfMeshesComeToTheAreaThatAnEdgeLeaves) {
    const scenes::Scene far_away = colored(quad({90, 0, 90}, {90, 0, 91}, {91, 0, 91}, {91, 0, 90}), red);
    Renderer renderer = voxels_of(far_away, 64);
    renderer.set_mix({.meshes = raster(half_plane_), .voxels_hidden = true});
    expect_less_with_each(renderer, 0.015);
}

TEST_F(Samples, AreAveragedInLinearLight) {
    const scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    Renderer renderer = voxel_renderer(scene, snapshot);
    View view;
    view.size = {96, 72};
    view.camera = optics::framing_camera(snapshot.bounds, 4.0 / 3.0);
    view.samples = 3;
    const renderer::Frame ours = renderer.render(view);
    std::vector<double> sums(ours.image.rgba.size());
    for (int i = 0; i < 3; ++i) {
        View one = view;
        one.samples = 1;
        one.pixel_place = renderer::sample_place(i, 3);
        const renderer::Frame sample = renderer.render(one);
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const double value = sample.image.rgba[k] / 255.0;
            sums[k] += (k % 4 == 3 ? value : optics::linear_from_srgb(value)) / 3.0;
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const double expected = 255.0 * (k % 4 == 3 ? sums[k] : optics::srgb_from_linear(sums[k]));
        ASSERT_NEAR(ours.image.rgba[k], expected, 0.51) << "byte " << k;
    }
    EXPECT_GT(ours.statistics.passes, 3);
}

TEST_F(Samples, AreRefusedWhereOneRayAPixelIsMarched) {
    const scenes::Snapshot snapshot = scenes::take_snapshot(half_plane_);
    Renderer renderer = voxel_renderer(half_plane_, snapshot);
    View several = view();
    several.samples = 2;
    EXPECT_THROW((void)renderer.render(several, {.budget = Milliseconds(1.0)}), Error);
    EXPECT_THROW((void)renderer.light(several), Error);
    for (const int samples : {0, -1, renderer::MAX_SAMPLES + 1}) {
        several.samples = samples;
        EXPECT_THROW((void)renderer.render(several), Error) << samples;
    }
    View beside = view();
    for (const double place : {-0.1, 1.0, std::nan("")}) {
        beside.pixel_place.y = place;
        EXPECT_THROW((void)renderer.render(beside), Error) << place;
    }
    beside.pixel_place = {0.25, 0.5};
    const scenes::Scene scene = square_over_floor();
    const scenes::Snapshot still = scenes::take_snapshot(scene);
    scenes::NodeSelection square(scene.nodes.size(), false);
    square[0] = true;
    const scenes::NodeSelection rest = scenes::other_nodes(square);
    beside.shadow.kind = renderer::ShadowQuality::Kind::rays;
    beside.light = optics::aimed_light({0.0, 4.0, 0.1}, {0.0, 0.0, 0.0}, 0.5, 0.5);
    View middle = beside;
    middle.pixel_place = glm::dvec2(0.5);
    for (const auto method : {renderer::ShadowMethod::pyramid, renderer::ShadowMethod::soft_shadow_map}) {
        renderer::ShadowScene shadowed{scene, still};
        if (method == renderer::ShadowMethod::soft_shadow_map) {
            shadowed.casters = square;
            shadowed.receivers = rest;
        }
        const auto shadows = renderer::make_shadow_renderer(method, shadowed, {});
        EXPECT_NO_THROW((void)shadows->render(middle));
        EXPECT_THROW((void)shadows->render(beside), Error);
    }
}

}  // namespace
}  // namespace cairn::test
