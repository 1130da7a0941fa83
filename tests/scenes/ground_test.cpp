// The ground that is added under a scene.

#include "scenes/ground.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "scenes/load.h"
#include "scenes/snapshot.h"

namespace cairn::test {
namespace {

TEST(Ground, LiesUnderTheSceneAndReachesPastItOnAllSides) {
    scenes::Scene scene = scenes::make_builtin("knot");
    const scenes::Snapshot before = scenes::take_snapshot(scene);
    const scenes::Bounds bounds = before.bounds;
    scenes::add_ground(scene, bounds);
    EXPECT_EQ(scene.nodes.back().name, "ground");
    const scenes::Snapshot snapshot = scenes::take_snapshot(scene);
    EXPECT_EQ(snapshot.triangle_count, before.triangle_count + 2);
    const scenes::Bounds all = snapshot.bounds;
    const glm::dvec3 extent = bounds.high - bounds.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    EXPECT_LT(all.low.y, bounds.low.y);
    EXPECT_GT(all.low.y, bounds.low.y - 0.01 * longest);
    EXPECT_EQ(all.high.y, bounds.high.y);
    for (const int axis : {0, 2}) {
        EXPECT_NEAR(all.high[axis] - all.low[axis], 2.0 * longest, 1e-6 * longest) << "axis " << axis;
        EXPECT_LT(all.low[axis], bounds.low[axis] - 0.4 * longest) << "axis " << axis;
        EXPECT_GT(all.high[axis], bounds.high[axis] + 0.4 * longest) << "axis " << axis;
    }
}

TEST(Ground, StandsInTheSceneThatIsAskedFor) {
    scenes::Scene scene = scenes::make_builtin("knot");
    scene.scenes.emplace_back();
    const scenes::Bounds bounds = scenes::take_snapshot(scene).bounds;
    scenes::add_ground(scene, bounds, 1);
    EXPECT_EQ(scenes::take_snapshot(scene, {0.0, std::nullopt, 1}).triangle_count, 2U);
    EXPECT_GT(scenes::take_snapshot(scene).triangle_count, 1000U);
    EXPECT_EQ(scenes::take_snapshot(scene).bounds.low.y, bounds.low.y);
}

TEST(Ground, IsNotAddedUnderNothing) {
    scenes::Scene scene = scenes::make_builtin("knot");
    const std::size_t nodes = scene.nodes.size();
    scenes::add_ground(scene, {});
    EXPECT_EQ(scene.nodes.size(), nodes);
}

}  // namespace
}  // namespace cairn::test
