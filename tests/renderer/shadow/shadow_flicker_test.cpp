// Soft shadows do not flicker while the light moves slowly: the samples' pattern stands still in the picture.

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/gl_fixture.h"
#include "tests/support/square_over_floor.h"

namespace cairn::test {
namespace {

class ShadowFlicker : public GlTest {};

/// The root of the mean square, over the pixels in penumbra and all frames, of the change of the light's
/// share from one frame to the next, less the change of the truth.
double flicker(SquareOverFloorScene& scene, int rays, bool cones) {
    constexpr int frames = 6;
    const glm::dvec2 step =
        0.001 * SquareOverFloorScene::light_height * glm::normalize(glm::dvec2(1.0, 0.37));
    std::vector<float> before;
    double squares = 0.0;
    int count = 0;
    for (int frame = 0; frame < frames; ++frame) {
        const glm::dvec2 moved = double(frame) * step;
        const std::vector<float> now = scene.renderer().light(scene.view(rays, cones, moved)).light.shares;
        for (int i = 0; frame > 0 && i < scene.size() * scene.size(); ++i) {
            const int x = i % scene.size();
            const int y = i / scene.size();
            const double truth = scene.truth(x, y, moved);
            const double truth_before = scene.truth(x, y, moved - step);
            if (truth == truth_before) continue;
            const double change = double(now[std::size_t(i)]) - double(before[std::size_t(i)]);
            squares += std::pow(change - (truth - truth_before), 2);
            ++count;
        }
        before = now;
    }
    EXPECT_GT(count, 1000 * (frames - 1) / 4) << "too little penumbra";
    return std::sqrt(squares / count);
}

// A ray is there or not, so a sample that an edge passes changes a pixel by one ray's share: rare at once
// with few rays, small with many.
TEST_F(ShadowFlicker, ALightThatMovesAThousandthOfItsDistanceChangesNoMoreThanAStepOfSixtyFour) {
    SquareOverFloorScene scene(96);
    for (const auto& [rays, cones] : {std::pair{16, false}, {64, false}, {4, true}, {16, true}}) {
        const double found = flicker(scene, rays, cones);
        RecordProperty(fmt::format("{}_{}", cones ? "cones" : "rays", rays), fmt::format("{:.5f}", found));
        EXPECT_LT(found, 1.0 / 64.0) << rays << (cones ? " cones" : " rays");
    }
}

}  // namespace
}  // namespace cairn::test
