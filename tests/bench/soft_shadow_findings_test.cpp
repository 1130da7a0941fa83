// The findings of Atty et al. 2005, section 4.2, on the error of soft shadow maps, as inequalities; and,
// where ours behave in another way, what is true instead. The chart `cairn bench soft-shadow-map` draws the
// curves.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/trials/soft_shadow_study.h"
#include "reference/image.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/soft_shadow_scene.h"

namespace cairn::test {
namespace {

using bench::shadow_points;
using bench::ShadowOccluder;
using bench::ShadowPlacement;
using bench::ShadowPoints;
using bench::soft_shadow_errors;
using bench::SoftShadowErrors;
using bench::study_light_height;
using bench::StudyCase;
using bench::StudyWindow;
using renderer::ShadowFormat;
using renderer::ShadowPasses;
using renderer::SoftShadowMap;
using renderer::SoftShadowOptions;

constexpr int receiver_size = 96;  // texels; the truth is known at 32 x 32 of them

SoftShadowOptions map_of(int size, ShadowPasses passes, ShadowFormat format = ShadowFormat::fp32) {
    return {size, receiver_size, passes, format};
}

/// An occluder over the floor, with the truth at the points of the floor.
class Placed {
public:
    Placed(const ShadowOccluder& occluder, const ShadowPlacement& placement)
        : study_(occluder, placement),
          mesh_(occluder.scene(), occluder.snapshot()),
          points_(shadow_points(map(map_of(64, ShadowPasses::one)))),
          truth_(bench::truth_at(points_, reference::ImageTracer(occluder.scene(), occluder.snapshot()),
                                 study_.light())) {}

    [[nodiscard]] SoftShadowMap map(const SoftShadowOptions& options,
                                    StudyWindow window = StudyWindow::fitted) const {
        SoftShadowMap map(options);
        map.compute(study_.light(), study_.frustum(window), mesh_, study_.floor());
        return map;
    }
    [[nodiscard]] SoftShadowErrors errors(const SoftShadowOptions& options,
                                          StudyWindow window = StudyWindow::fitted) const {
        return soft_shadow_errors(map(options, window).visible(), points_, truth_);
    }
    /// Mean errors of one pass and of two passes.
    [[nodiscard]] double one(int size, StudyWindow window = StudyWindow::fitted) const {
        return errors(map_of(size, ShadowPasses::one), window).mean;
    }
    [[nodiscard]] double two(int size) const { return errors(map_of(size, ShadowPasses::two)).mean; }

    [[nodiscard]] const StudyCase& study() const { return study_; }
    [[nodiscard]] const ShadowPoints& points() const { return points_; }
    [[nodiscard]] const std::vector<double>& truth() const { return truth_; }

private:
    StudyCase study_;
    renderer::ShadowMesh mesh_;
    ShadowPoints points_;
    std::vector<double> truth_;
};

class SoftShadowFindings : public GlTest {
protected:
    const ShadowOccluder square_{"builtin:square"};
    const ShadowOccluder knot_{"builtin:knot"};
};

/// The share of the light that is seen past the unit square, in closed form.
double seen_past_square(const StudyCase& study, const glm::dvec3& point) {
    const glm::dvec3 light = study.light().position;
    const double x = -light.x;
    const std::vector<glm::dvec2> polygon = {
        {x - 0.5, -0.5}, {x + 0.5, -0.5}, {x + 0.5, 0.5}, {x - 0.5, 0.5}};
    return visible_past(polygon, light.y, {point.x - light.x, point.z, light.y - point.y},
                        optics::half_size(study.light()));
}

// All figures depend on this: the points lie on the floor, at the places of the map's texels, and the truth
// of these points is right.
TEST_F(SoftShadowFindings, StandOnTheRightPointsAndTheRightTruth) {
    const Placed placed(square_, {.light_width = 0.6, .lateral = 0.4, .gap = 0.7});
    const renderer::ShadowMapValues visible = placed.map(map_of(50, ShadowPasses::one)).visible();
    ASSERT_EQ(placed.points().world.size(), std::size_t(32 * 32));
    int shadowed = 0;
    for (std::size_t i = 0; i < placed.points().world.size(); ++i) {
        const glm::dvec3 point = placed.points().world[i];
        const glm::ivec2 texel = placed.points().texels[i];
        ASSERT_NEAR(point.y, placed.study().floor_height(), 1e-5) << "point " << i;
        const double exact = seen_past_square(placed.study(), point);
        ASSERT_NEAR(visible.at(texel.x, texel.y), exact, 1e-4) << "texel " << texel.x << ", " << texel.y;
        ASSERT_NEAR(placed.truth()[i], exact, 0.02) << "texel " << texel.x << ", " << texel.y;
        shadowed += exact < 1.0 ? 1 : 0;
    }
    EXPECT_GT(shadowed, 500);
    EXPECT_LT(placed.one(50), 0.002) << "the truth's own error";
}

TEST_F(SoftShadowFindings, CuttingTheTrianglesKeepsTheShadow) {
    const Placed whole(knot_, {});
    const ShadowOccluder finer = knot_.cut(2);
    EXPECT_EQ(finer.snapshot().triangle_count, 4 * knot_.snapshot().triangle_count);
    const renderer::ShadowMesh mesh(finer.scene(), finer.snapshot());
    SoftShadowMap map(map_of(96, ShadowPasses::two));
    map.compute(whole.study().light(), whole.study().frustum(StudyWindow::fitted), mesh,
                whole.study().floor());
    const double cut = soft_shadow_errors(map.visible(), whole.points(), whole.truth()).mean;
    EXPECT_NEAR(cut, whole.two(96), 2e-4);
}

// 4.2.3: "always giving more accurate results. The only exception is of course the square plane".
TEST_F(SoftShadowFindings, TwoPassesBeatOneExceptForTheSquare) {
    const Placed knot(knot_, {});
    for (const int size : {32, 128, 256})
        EXPECT_LT(knot.two(size), 0.8 * knot.one(size)) << "knot, " << size;
    const Placed square(square_, {.gap = 0.5});
    for (const StudyWindow window : {StudyWindow::fitted, StudyWindow::shared}) {
        EXPECT_EQ(square.map(map_of(128, ShadowPasses::one), window).visible().values,
                  square.map(map_of(128, ShadowPasses::two), window).visible().values);
    }
}

// 4.2.3: "increasing the shadow map resolution above 200 pixels does not bring an improvement in quality."
TEST_F(SoftShadowFindings, NothingIsGainedBeyond200Texels) {
    const Placed knot(knot_, {});
    for (const ShadowPasses passes : {ShadowPasses::one, ShadowPasses::two}) {
        const double at_16 = knot.errors(map_of(16, passes)).mean;
        const double at_200 = knot.errors(map_of(200, passes)).mean;
        const double at_400 = knot.errors(map_of(400, passes)).mean;
        EXPECT_GT(at_16, 1.2 * at_200) << int(passes);
        EXPECT_NEAR(at_400, at_200, 0.04 * at_200) << int(passes);
    }
}

// 4.2.3 and 5.2.3: "As the light source gets larger, we can use smaller bitmaps."
TEST_F(SoftShadowFindings, ALargeLightNeedsASmallerMap) {
    const Placed small(knot_, {.light_width = 0.05});
    const Placed large(knot_, {.light_width = 0.75});
    EXPECT_GT(small.two(64), 2.0 * small.two(256));
    EXPECT_LT(large.two(64), 1.1 * large.two(256));
}

// 4.2.3: "the error curve for the square plane presents many important spikes": its edges fall on texels'
// edges or between them. With one window for both maps, as in the paper, that is so here. A window fitted to
// the occluders, which is ours, has an aligned square's edges on its own, and no error at any size.
TEST_F(SoftShadowFindings, TheAlignedSquareHasSpikesUnlessTheWindowIsFitted) {
    const Placed square(square_, {.gap = 0.5});
    int turns = 0;
    std::vector<double> means;
    for (const int size : {24, 32, 48, 64, 96, 128, 160}) {
        EXPECT_LT(square.one(size), 0.002) << "fitted, " << size;
        means.push_back(square.one(size, StudyWindow::shared));
    }
    for (std::size_t i = 1; i + 1 < means.size(); ++i)
        turns += (means[i] > means[i - 1]) != (means[i + 1] > means[i]) ? 1 : 0;
    EXPECT_GE(turns, 2) << "the curve has no spikes";
    EXPECT_GT(*std::max_element(means.begin(), means.end()), 0.02);
}

// 4.2.4: "except for the special case of point light sources, the error increases with the size of the light
// source."
TEST_F(SoftShadowFindings, ErrorGrowsWithTheLight) {
    double before = 0.0;
    for (const double width : {0.1, 0.25, 0.5, 1.0}) {
        const Placed knot(knot_, {.light_width = width});
        const double mean = knot.two(128);
        EXPECT_GT(mean, 1.2 * before) << "light of " << width;
        before = mean;
    }
}

// 4.2.4: a point light's error is "quite large", "an error of 1, over the entire shadow boundary", but "it
// occurs only at the shadow boundary": within half a texel of the occluder map.
TEST_F(SoftShadowFindings, APointLightIsWrongAtTheShadowsEdgeAlone) {
    // No multiple of the points per side: they would all lie in the middle of patches.
    const int size = 44;
    const Placed point(knot_, {.light_width = 0.01});
    const Placed small(knot_, {.light_width = 0.2});
    const SoftShadowErrors errors = point.errors(map_of(size, ShadowPasses::two));
    const SoftShadowErrors of_small = small.errors(map_of(size, ShadowPasses::two));
    EXPECT_GT(errors.mean, 1.1 * of_small.mean);
    EXPECT_GT(errors.rmse, 2.5 * of_small.rmse);
    EXPECT_GT(errors.greatest, 0.9);
    EXPECT_GT(errors.wrong, 5U);
    EXPECT_LT(errors.wrong, errors.shadowed / 10);

    const SoftShadowMap map = point.map(map_of(size, ShadowPasses::two));
    const renderer::ShadowMapValues visible = map.visible();
    const renderer::ShadowFrustum frustum = map.frustum();
    const glm::dvec2 texel = (frustum.occluders.high - frustum.occluders.low) / double(size);
    // The truth on the floor around each wrong point, one and a half texels of the occluder map away.
    const reference::ImageTracer tracer(knot_.scene(), knot_.snapshot());
    for (std::size_t i = 0; i < point.truth().size(); ++i) {
        const glm::ivec2 at = point.points().texels[i];
        if (std::abs(visible.at(at.x, at.y) - point.truth()[i]) <= 1.0 / 16.0) continue;
        ShadowPoints around;
        for (int k = 0; k < 16; ++k) {
            const double angle = k * 0.39269908169872414;
            const glm::dvec2 aside =
                1.5 * study_light_height * texel * glm::dvec2(std::cos(angle), std::sin(angle));
            around.world.push_back(point.points().world[i] + glm::dvec3(aside.x, 0.0, aside.y));
        }
        const std::vector<double> there = bench::truth_at(around, tracer, point.study().light());
        const auto [least, most] = std::minmax_element(there.begin(), there.end());
        EXPECT_GT(*most - *least, 0.9) << "texel " << at.x << ", " << at.y << " is wrong inside the shadow";
    }
}

// 4.2.5 finds the least error under the light, growing to both sides. Not so here: an occluder that moves
// aside under a light parallel to the floor is only sheared in light space. Depths, patches and the light as
// seen from the floor stay the same; only the part of the occluder that the light's middle sees changes. This
// changes the error by less than a factor of two, to either side; for the knot, which is not its own mirror
// image, the error falls to one side. For the square, which is flat, the error is the same everywhere.
TEST_F(SoftShadowFindings, MovingAsideChangesLittle) {
    std::vector<double> means;
    for (const double lateral : {-1.5, -0.75, 0.0, 0.75, 1.5})
        means.push_back(Placed(knot_, {.lateral = lateral}).two(128));
    const auto [least, most] = std::minmax_element(means.begin(), means.end());
    EXPECT_LT(*most, 2.0 * *least);
    EXPECT_LT(*least, 0.9 * means[2]) << "the least error is under the light, as in the paper";
    for (const double lateral : {-1.5, 0.0, 1.5})
        EXPECT_LT(Placed(square_, {.lateral = lateral, .gap = 0.5}).one(128), 0.002) << lateral;
}

// 4.2.6: "the error increases as the occluder approaches the light source": equation 3 has no bound there. In
// the mean over the shadow it need not grow all the way, because the penumbra grows too and most of it is
// faint; but nowhere is it so large as at the light, where two passes do not help either.
TEST_F(SoftShadowFindings, ErrorIsLargestAtTheLight) {
    const double way = study_light_height - knot_.height();
    const double on_floor = Placed(knot_, {}).two(128);
    const double between = Placed(knot_, {.gap = 0.5 * way}).two(128);
    const Placed at_light(knot_, {.gap = 0.98 * way});
    EXPECT_GT(between, 1.2 * on_floor);
    EXPECT_GT(at_light.two(128), 1.4 * between);
    EXPECT_GT(at_light.two(128), 0.8 * at_light.one(128));
}

// Figure 14 and appendix A: FP16 breaks at 512^2 texels and not at 128^2; batches and FP32 mend it. At 128^2
// it is not free of loss either: each sum rounds.
TEST_F(SoftShadowFindings, Fp16BreaksAt512AndIsMended) {
    const Placed knot(knot_, {});
    const auto error = [&](int size, ShadowFormat format) {
        return knot.errors(map_of(size, ShadowPasses::one, format)).mean;
    };
    EXPECT_LT(error(128, ShadowFormat::fp16), 1.8 * error(128, ShadowFormat::fp32));
    const double whole = error(512, ShadowFormat::fp32);
    EXPECT_GT(error(512, ShadowFormat::fp16), 4.0 * whole);
    EXPECT_LT(error(512, ShadowFormat::fp16_batches), 1.3 * whole);
}

}  // namespace
}  // namespace cairn::test
