// Bricks that are filled on the CPU, as the marcher sees them.

#include "renderer/produce/cpu_brick.h"

#include <gtest/gtest.h>

#include "renderer/pool/brick_pool.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/produced_brick.h"

namespace cairn::test {
namespace {

using renderer::BrickPool;
using renderer::CpuBrick;
using renderer::TreeShape;

class CpuBrickTest : public GlTest, public ::testing::WithParamInterface<int> {
protected:
    [[nodiscard]] static TreeShape shape() {
        return GetParam() % 3 == 0 ? TreeShape{.n = 3, .m = GetParam(), .max_level = 1}
                                   : TreeShape{.n = 4, .m = GetParam(), .max_level = 1};
    }
};

TEST_P(CpuBrickTest, HoldsWhatWasSetAndNothingElse) {
    const int m = GetParam();
    BrickPool pool(shape(), true, 8 * slot_bytes(m, true));
    CpuBrick brick(shape(), {.color = true});
    EXPECT_TRUE(brick.is_empty());
    const glm::ivec3 inside(m - 1, 1, m / 2);
    const glm::ivec3 border(-1, m, 0);
    const glm::ivec3 taken_back(2, 3, 4);
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3F, -0.5F, -0.8F));
    brick.set(inside, 1.0, normal, {1.0F, 0.25F, 0.0F});
    brick.set(border, 0.5, {0.0F, 1.0F, 0.0F}, {1.0F, 1.0F, 1.0F});
    brick.set(taken_back, 1.0, normal, {1.0F, 1.0F, 1.0F});
    brick.set(taken_back, 0.0, normal);
    EXPECT_FALSE(brick.is_empty());
    brick.send_to(pool, 1);

    const ProducedBrick read = read_brick(pool, shape(), 1);
    EXPECT_EQ(read.color_at(inside), glm::ivec4(255, 128, 0, 255));
    EXPECT_EQ(read.color_at(border), glm::ivec4(180, 180, 180, 128));
    EXPECT_GT(glm::dot(read.normal_at(inside), normal), 0.9999F);
    EXPECT_GT(glm::dot(read.second_normal_at(inside), normal), 0.99F);
    EXPECT_EQ(read.second_share_at(inside), 0.0F);
    EXPECT_EQ(read.normal_at(border), glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_EQ(read.normal_at(taken_back), glm::vec3(0.0F));
    EXPECT_EQ(mask_bits(read).count(), 1U);
    EXPECT_TRUE(read.occupied(inside));
    EXPECT_TRUE(read.summary_at(inside / shape().block_side()));
    EXPECT_EQ(coverage_bits(read).count(), 2U);
    EXPECT_FALSE(read.summary_at(taken_back / shape().block_side()) &&
                 taken_back / shape().block_side() != inside / shape().block_side());
}

INSTANTIATE_TEST_SUITE_P(Sides, CpuBrickTest, ::testing::Values(8, 16, 27));

class CpuBrickOfASolid : public GlTest {};

TEST_F(CpuBrickOfASolid, WithoutAColourHoldsTheCoverage) {
    const TreeShape shape{.n = 4, .m = 8, .max_level = 1};
    BrickPool pool(shape, false, 8 * slot_bytes(8, false));
    CpuBrick brick(shape, {.color = false});
    brick.set({0, 7, 3}, 1.0, {0.0F, 0.0F, 1.0F});
    brick.send_to(pool, 0);
    const ProducedBrick read = read_brick(pool, shape, 0);
    EXPECT_EQ(read.color_at({0, 7, 3}).a, 255);
    EXPECT_EQ(coverage_bits(read).count(), 1U);
    EXPECT_TRUE(read.occupied({0, 7, 3}));
}

}  // namespace
}  // namespace cairn::test
