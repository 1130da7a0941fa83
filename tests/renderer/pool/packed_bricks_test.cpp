// Packed bricks: bounded in bytes, never one over another, and many more of them than of dense ones.
#include "renderer/pool/packed_bricks.h"

#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "renderer/pool/brick_pool.h"
#include "scenes/load.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/produced_brick.h"
#include "tests/support/tree_view.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

class PackedBricksTest : public GlTest {};

TEST_F(PackedBricksTest, TakeNoMoreBytesThanAskedFor) {
    for (const int m : {8, 16, 32}) {
        for (const bool has_color : {false, true}) {
            const TreeShape shape = make_tree_shape_within(4, m, 8192);
            const std::size_t least = least_packed_bytes(shape, has_color);
            for (const std::size_t bytes : {least, least + 1, 3 * least, std::size_t(20) << 20U}) {
                const PackedBricks bricks(shape, has_color, bytes);
                EXPECT_LE(bricks.size_bytes(), bytes) << "M = " << m;
                EXPECT_GE(bricks.size_bytes() + 64, bytes) << "M = " << m;
                EXPECT_GE(bricks.free_words(), most_packed_words(shape, has_color)) << "a full brick fits";
            }
            EXPECT_THROW(PackedBricks(shape, has_color, least - 1), Error);
        }
    }
}

TEST_F(PackedBricksTest, RunsOfSlotsNeverOverlap) {
    const TreeShape shape = make_tree_shape(4, 8, 512);
    PackedBricks bricks(shape, true, std::size_t(256) << 10U);
    Random random(5);
    for (int step = 0; step < 4000; ++step) {
        const int slot = int(random.between(0, bricks.slot_count() - 1));
        if (random.between(0, 2) == 0) {
            bricks.release(slot);
        } else {
            (void)bricks.reserve(slot, std::uint32_t(random.between(1, 3000)));
        }
        if (step % 100 != 0) continue;
        std::vector<bool> used(bricks.words().size_bytes() / 4, false);
        for (int held = 0; held < bricks.slot_count(); ++held) {
            if (!bricks.has_room(held)) continue;
            const PackedBricks::Run run = bricks.run(held);
            for (std::uint32_t word = run.first; word < run.first + run.words; ++word) {
                ASSERT_FALSE(used.at(word)) << "step " << step << ", slot " << held;
                used[word] = true;
            }
        }
    }
}

TEST_F(PackedBricksTest, PoolHoldsManyTimesAsManyBricksAsADenseOne) {
    // A leaf of the tree fills a voxel or less, so that its bricks are fuller than those of closed surfaces.
    for (const auto& [name, times] : {std::pair{"knot", 8.0}, {"tree", 3.6}}) {
        const scenes::Scene scene = scenes::make_builtin(name);
        View view;
        view.size = {512, 512};
        view.camera = optics::framing_camera(scenes::take_snapshot(scene).bounds, 1.0);
        Renderer renderer =
            voxel_renderer(scene, scenes::take_snapshot(scene), {.tree = {.max_resolution = 8192}});
        const FrameStatistics statistics = renderer.render(view).statistics;
        const double packed = double(statistics.brick_bytes_resident) / double(statistics.bricks_resident);
        const bool has_color = std::string_view(name) == "tree";
        fmt::print("{}: {:.0f} bytes a brick, {:.2f} times\n", name, packed,
                   double(slot_bytes(16, has_color)) / packed);
        EXPECT_LT(packed * times, double(slot_bytes(16, has_color))) << name << ": bytes of a brick";
    }
}

}  // namespace
}  // namespace cairn::renderer
