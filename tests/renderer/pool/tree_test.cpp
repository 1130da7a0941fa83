// The N^3-tree's mirror and its caches: which bricks and blocks are evicted, and which never are.
#include "renderer/pool/tree.h"

#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "shaders/interop/pool.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/tree_view.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

TEST(TreeShapeTest, IsTheLeastAroundTheVoxelsOrTheDeepestWithinThem) {
    EXPECT_EQ(make_tree_shape(4, 16, 4096).resolution(), 4096);
    EXPECT_EQ(make_tree_shape(4, 16, 4097).resolution(), 16384);
    EXPECT_EQ(make_tree_shape_within(4, 16, 16383).resolution(), 4096);
    EXPECT_EQ(make_tree_shape(2, 8, 8).max_level, 0);
    EXPECT_EQ(make_tree_shape(2, 8, 1 << MAX_RESOLUTION_BITS).max_level, 18);
    EXPECT_EQ(most_voxels_across(2, 8), 1 << MAX_RESOLUTION_BITS);
    EXPECT_EQ(most_voxels_across(4, 16), 1 << 20);
    for (const int n : {2, 3, 4, 8}) {
        for (const int m : n == 3 ? std::vector{27, 81} : std::vector{8, 16, 32, 64}) {
            for (int voxels = m; voxels <= most_voxels_across(n, m); voxels += 1 + voxels / 7) {
                const auto where = fmt::format("N = {}, M = {}, {} voxels", n, m, voxels);
                std::int64_t side = m;
                int levels = 0;
                for (; side < voxels; ++levels)
                    side *= n;
                const TreeShape around = make_tree_shape(n, m, voxels);
                ASSERT_EQ(around.max_level, levels) << where;
                ASSERT_EQ(around.resolution(), side) << where;
                const TreeShape within = make_tree_shape_within(n, m, voxels);
                ASSERT_EQ(within.resolution(), side == voxels ? side : side / n) << where;
            }
        }
    }
}

TEST(TreeShapeTest, RefusesWhatCannotWorkAndSaysWhatCan) {
    struct Wrong {
        int n, m, limit;
        const char* hint;
    };
    for (const Wrong& wrong :
         {Wrong{3, 16, 8192, "27 or 81"}, Wrong{0, 16, 8192, "2, 3, 4 or 8"},
          Wrong{8, 27, 8192, "8, 16, 32 or 64"}, Wrong{4, 12, 8192, "8, 16, 32 or 64"},
          Wrong{4, 4, 8192, "8, 16, 32 or 64"}, Wrong{4, 128, 8192, "8, 16, 32 or 64"},
          Wrong{4, 16, 15, "between 16"}, Wrong{2, 8, 0, "between 8"}, Wrong{2, 8, -1, "between 8"},
          Wrong{4, 16, (1 << 20) + 1, "1048576"}, Wrong{2, 8, (1 << MAX_RESOLUTION_BITS) + 1, "2097152"}}) {
        try {
            (void)make_tree_shape(wrong.n, wrong.m, wrong.limit);
            ADD_FAILURE() << fmt::format("N = {}, M = {}, limit {} was accepted", wrong.n, wrong.m,
                                         wrong.limit);
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::usage);
            EXPECT_NE(std::string(error.what()).find(wrong.hint), std::string::npos) << error.what();
        }
    }
}

TEST(TreeShapeTest, EveryTileHasItsOwnHashAndItsParent) {
    std::set<std::size_t> hashes;
    std::size_t tiles = 0;
    for (const int level : {0, 1, 2, 17, 18, 60}) {
        const std::int64_t last = (std::int64_t(1) << level) - 1;
        const std::set<std::int64_t> places{0, last / 3, last};
        for (const std::int64_t x : places) {
            for (const std::int64_t y : places) {
                for (const std::int64_t z : places) {
                    const Tile tile{level, {x, y, z}};
                    hashes.insert(TileHash{}(tile));
                    ++tiles;
                    for (const int n : {2, 3, 4, 8}) {
                        for (int child = 0; child < n * n * n; ++child) {
                            const Tile below = child_of(tile, n, child);
                            const Tile parent{below.level - 1, below.position / std::int64_t(n)};
                            ASSERT_EQ(parent, tile) << "N = " << n;
                        }
                    }
                }
            }
        }
    }
    EXPECT_EQ(hashes.size(), tiles);
}

/// A tree of N = 2, M = 8 and three levels under the root, with few blocks and slots. Its rounds are counted.
class TreeTest : public GlTest {
protected:
    void make(int blocks, int slots) {
        slots_ = slots;
        const TreeShape shape = make_tree_shape(2, 8, 64);
        tree_.emplace(shape, slots, bytes_of_blocks(shape, blocks), glm::uvec2(0xFF, 0));
        next_round();
    }
    Tree& tree() { return *tree_; }
    [[nodiscard]] Round round() const { return {round_}; }
    [[nodiscard]] Reached reached() const { return walk(*tree_, slots_); }

    /// Ends a pass that used these slots.
    void next_round(const std::vector<int>& used_slots = {}) {
        std::vector<std::uint32_t> stamps(std::size_t(slots_), 0);
        for (const int slot : used_slots)
            stamps[std::size_t(slot)] = round_;
        tree_->begin_round(Round{++round_}, stamps);
    }
    std::uint32_t children(std::uint32_t entry) {
        const std::optional<std::uint32_t> first = tree_->add_children(entry);
        EXPECT_TRUE(first.has_value()) << "no block for the children of entry " << entry;
        return first.value_or(0);
    }
    int brick(std::uint32_t entry) {
        const std::optional<int> slot = tree_->add_brick(entry);
        EXPECT_TRUE(slot.has_value()) << "no slot for entry " << entry;
        return slot.value_or(0);
    }

private:
    int slots_ = 0;
    std::uint32_t round_ = 0;
    std::optional<Tree> tree_;
};

TEST_F(TreeTest, StartsWithARootThatHasNothing) {
    make(8, 4);
    EXPECT_TRUE(tree().wants_children(0));
    EXPECT_TRUE(tree().wants_brick(0));
    EXPECT_EQ(tree().tile(0), Tile{});
    EXPECT_EQ(tree().node(0).child_mask, glm::uvec2(0xFF, 0));
    EXPECT_EQ(tree().bricks_resident(), 0);
    EXPECT_TRUE(gpu_equals_mirror(tree()));
}

TEST_F(TreeTest, ChildrenAreTheTilesOfTheRegularSubdivisionDownToTheFinest) {
    make(16, 4);
    std::uint32_t entry = 0;
    for (int level = 0; level < tree().shape().max_level; ++level) {
        ASSERT_TRUE(tree().wants_children(entry)) << "level " << level;
        const std::uint32_t first = children(entry);
        EXPECT_FALSE(tree().wants_children(entry)) << "it has children now";
        EXPECT_EQ(tree().node(entry).children, first);
        for (std::uint32_t child = 0; child < 8; ++child) {
            EXPECT_EQ(tree().node(first + child).child_mask, glm::uvec2(0)) << "empty until it is told";
            tree().set_child_mask(first + child, {child, level});
        }
        next_round();
        entry = first + 5;
        EXPECT_EQ(tree().tile(entry).level, level + 1);
        EXPECT_EQ(tree().tile(entry).position, glm::i64vec3((2 << level) - 1, 0, (2 << level) - 1));
        EXPECT_EQ(tree().node(entry).child_mask, glm::uvec2(5, level));
    }
    EXPECT_FALSE(tree().wants_children(entry)) << "the finest level has no children";
    EXPECT_TRUE(tree().wants_brick(entry));
    EXPECT_EQ(reached().blocks, 4);
    tree().upload();
    EXPECT_TRUE(gpu_equals_mirror(tree()));
}

TEST_F(TreeTest, ABrickSettlesTheQuestion) {
    make(8, 4);
    const int slot = brick(0);
    EXPECT_FALSE(tree().wants_brick(0));
    EXPECT_EQ(tree().node(0).brick, std::uint32_t(slot) + 1);
    EXPECT_EQ(tree().bricks_resident(), 1);
    EXPECT_TRUE(tree().wants_children(0)) << "a tile may have both";
}

TEST_F(TreeTest, SlotUnusedForLongestIsTakenFirst) {
    make(8, 4);
    const std::uint32_t first = children(0);
    int slots[4];
    for (std::uint32_t child = 0; child < 4; ++child)
        slots[child] = brick(first + child);
    next_round();
    // Three slots are used in three passes, one each; the fourth is never used after its production.
    next_round({slots[2]});
    next_round({slots[0]});
    next_round({slots[3]});
    const std::uint32_t expected[4] = {1, 2, 0, 3};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const int slot = brick(first + 4 + i);
        EXPECT_EQ(slot, slots[expected[i]]) << "taken as number " << i;
        EXPECT_EQ(tree().node(first + expected[i]).brick, 0U) << "its old owner still points at it";
        EXPECT_EQ(tree().counters().bricks_evicted, i + 1);
    }
    EXPECT_EQ(tree().bricks_resident(), 4);
    EXPECT_FALSE(tree().add_brick(first + 1).has_value()) << "all were given out in this round";
    EXPECT_EQ(reached().bricks, 4);
}

TEST_F(TreeTest, CountsTheBricksThatAFrameUsed) {
    make(8, 4);
    const std::uint32_t first = children(0);
    const int kept = brick(first);
    const int unused = brick(first + 1);
    EXPECT_EQ(tree().bricks_used_since(round()), 2) << "given out in this round";
    next_round();
    const Round frame = round();
    EXPECT_EQ(tree().bricks_used_since(frame), 0);
    next_round({kept});
    (void)brick(first + 2);
    next_round();
    EXPECT_EQ(tree().bricks_used_since(frame), 2) << "one by rays, one given out";
    EXPECT_EQ(tree().bricks_used_since(frame.before()), 3) << "slot " << unused << " is still resident";
    EXPECT_EQ(tree().bricks_resident(), 3);
}

TEST_F(TreeTest, WhatWasGivenOutInARoundStaysUntilTheNext) {
    make(8, 3);
    const std::uint32_t first = children(0);
    for (std::uint32_t child = 0; child < 3; ++child)
        (void)brick(first + child);
    EXPECT_FALSE(tree().add_brick(first + 3).has_value());
    EXPECT_EQ(tree().counters().bricks_evicted, 0U);
    for (std::uint32_t child = 0; child < 3; ++child)
        EXPECT_NE(tree().node(first + child).brick, 0U) << "child " << child;
    next_round();
    EXPECT_TRUE(tree().wants_brick(first + 3)) << "still a question in the next round";
    EXPECT_TRUE(tree().add_brick(first + 3).has_value());
    EXPECT_EQ(tree().counters().bricks_evicted, 1U);
}

TEST_F(TreeTest, UsedBrickRenewsThePathToTheRoot) {
    // The root's, its children, and two branches of two levels.
    make(6, 8);
    const std::uint32_t top = children(0);
    const std::uint32_t used = children(top);
    const int used_brick = brick(children(used));
    const std::uint32_t unused = children(top + 1);
    (void)brick(children(unused));
    EXPECT_EQ(reached().blocks, 6);
    for (int round = 0; round < 3; ++round)
        next_round({used_brick});
    // Two more blocks: the branch that no ray used is evicted, its deepest block first.
    (void)children(top + 2);
    EXPECT_EQ(tree().node(unused).children, 0U);
    EXPECT_NE(tree().node(top + 1).children, 0U) << "the parent went before it had to";
    (void)children(top + 3);
    EXPECT_EQ(tree().node(top + 1).children, 0U);
    EXPECT_EQ(tree().node(top).children, used) << "the used path was cut";
    EXPECT_NE(tree().node(used).children, 0U) << "the used path was cut";
    EXPECT_EQ(reached().bricks, 1);
    EXPECT_EQ(tree().counters().nodes_evicted, 2U);
    EXPECT_EQ(tree().counters().bricks_evicted, 0U) << "its brick stays in its slot";
    EXPECT_EQ(tree().orphans().size(), 1U);
}

TEST_F(TreeTest, ParentOutlivesItsChildren) {
    make(5, 8);
    std::uint32_t chain[4] = {0, 0, 0, 0};
    for (int level = 0; level < 3; ++level) {
        chain[level + 1] = children(chain[level]);
        next_round();
    }
    const std::uint32_t other = children(chain[1] + 1);  // the last free block
    next_round();
    const std::uint32_t next = children(chain[1] + 2);
    EXPECT_EQ(next, chain[3]) << "the oldest block without child blocks is the deepest of the chain";
    EXPECT_EQ(tree().node(chain[2]).children, 0U);
    EXPECT_EQ(tree().node(chain[1]).children, chain[2]);
    EXPECT_EQ(tree().node(chain[1] + 1).children, other);
    EXPECT_EQ(tree().counters().nodes_evicted, 1U);
    EXPECT_EQ(reached().blocks, 5);
}

TEST_F(TreeTest, EvictedBlockLeavesItsBricksInTheirSlots) {
    make(5, 8);
    const std::uint32_t top = children(0);
    const std::uint32_t old = children(top);
    for (std::uint32_t child = 0; child < 8; ++child)
        (void)brick(old + child);
    EXPECT_FALSE(tree().add_brick(top + 3).has_value()) << "every slot was given out in this round";
    next_round();
    (void)children(top + 1);
    (void)children(top + 2);
    next_round();
    EXPECT_EQ(children(top + 4), old) << "the oldest block was another";
    EXPECT_EQ(tree().node(top).children, 0U);
    EXPECT_EQ(tree().bricks_resident(), 8);
    EXPECT_EQ(tree().orphans().size(), 8U);
    EXPECT_EQ(tree().counters().bricks_evicted, 0U);
    EXPECT_EQ(tree().counters().nodes_evicted, 1U);
    for (std::uint32_t child = 0; child < 8; ++child)
        EXPECT_EQ(tree().node(old + child).brick, 0U) << "child " << child << " of the new block";
    EXPECT_EQ(reached().bricks, 0);
    tree().upload();
    EXPECT_TRUE(gpu_equals_mirror(tree()));
}

TEST_F(TreeTest, BrickIsLinkedAgainWhenItsTileComesBack) {
    make(5, 2);
    const std::uint32_t top = children(0);
    const std::uint32_t old = children(top);
    const int slot = brick(old + 3);
    const int other = brick(old + 5);
    next_round({slot});
    next_round({slot});
    (void)children(top + 1);
    (void)children(top + 2);
    next_round();
    (void)children(top + 4);
    ASSERT_EQ(tree().orphans().size(), 2U);
    // The older of the two is evicted; the other is there when its tile is queried again.
    EXPECT_EQ(brick(top), other);
    EXPECT_EQ(tree().counters().bricks_evicted, 1U);
    next_round();
    const std::uint32_t again = children(top);
    EXPECT_EQ(tree().node(again + 3).brick, std::uint32_t(slot) + 1);
    EXPECT_EQ(tree().node(again + 5).brick, 0U);
    EXPECT_EQ(tree().counters().bricks_relinked, 1U);
    EXPECT_TRUE(tree().orphans().empty());
    tree().upload();
    EXPECT_TRUE(gpu_equals_mirror(tree()));
}

TEST_F(TreeTest, BricksThatMayNotStayNeverTakeTurns) {
    make(16, 2);
    const std::uint32_t top = children(0);
    (void)brick(top);
    (void)brick(top + 1);
    next_round();
    next_round();
    tree().keep_since(Round{3});
    EXPECT_TRUE(tree().add_brick(top + 2, false).has_value()) << "an older brick was there";
    next_round();
    EXPECT_TRUE(tree().add_brick(top + 3, false).has_value()) << "an older brick was there";
    next_round();
    EXPECT_FALSE(tree().add_brick(top + 4, false).has_value()) << "it took the place of its like";
    EXPECT_TRUE(tree().add_brick(top + 4, true).has_value());
}

TEST_F(TreeTest, SlotIsGivenOutOnceInARoundHoweverOldItsBrickCounts) {
    make(8, 2);
    const std::uint32_t top = children(0);
    tree().keep_since(round());
    EXPECT_TRUE(tree().add_brick(top, false).has_value());
    EXPECT_TRUE(tree().add_brick(top + 1, false).has_value());
    // Both slots wait to be filled. A brick that is needed now must not get one of them.
    EXPECT_FALSE(tree().add_brick(top + 2).has_value());
    EXPECT_TRUE(tree().slot(top).has_value());
    EXPECT_TRUE(tree().slot(top + 1).has_value());
    next_round();
    EXPECT_TRUE(tree().add_brick(top + 2).has_value()) << "it is filled now, and may go";
}

TEST_F(TreeTest, EntriesOfABlockTakenAwayWantNothingInThatRound) {
    make(5, 8);
    const std::uint32_t top = children(0);
    const std::uint32_t old = children(top);
    next_round();
    (void)children(top + 1);
    (void)children(top + 2);
    next_round();
    ASSERT_TRUE(tree().wants_brick(old + 3));
    ASSERT_TRUE(tree().wants_children(old + 3));
    const std::uint32_t reused = children(top + 5);
    ASSERT_EQ(reused, old);
    EXPECT_FALSE(tree().wants_brick(reused + 3)) << "the rays asked for another tile's brick";
    EXPECT_FALSE(tree().wants_children(reused + 3)) << "the rays asked for another tile's children";
    next_round();
    EXPECT_TRUE(tree().wants_brick(reused + 3)) << "from now on rays speak of the new tile";
    EXPECT_TRUE(tree().wants_children(reused + 3));
}

TEST_F(TreeTest, BlocksOfARoundAreNeverTakenInIt) {
    make(5, 8);
    const std::uint32_t top = children(0);
    for (std::uint32_t child = 0; child < 3; ++child)
        (void)children(top + child);
    EXPECT_FALSE(tree().add_children(top + 3).has_value());
    EXPECT_FALSE(tree().add_children(top + 4).has_value());
    EXPECT_EQ(tree().counters().nodes_evicted, 0U);
    EXPECT_EQ(reached().blocks, 5);
    next_round();
    for (std::uint32_t child = 3; child < 6; ++child)
        (void)children(top + child);
    EXPECT_FALSE(tree().add_children(top + 6).has_value());
    EXPECT_EQ(tree().counters().nodes_evicted, 3U);
    EXPECT_EQ(reached().blocks, 5);
}

TEST_F(TreeTest, WholeOldBranchIsTakenWhenOneRoundNeedsIt) {
    // Taking the deepest block makes its parent's the next: more than one search must reach them all.
    make(5, 8);
    const std::uint32_t top = children(0);
    const std::uint32_t middle = children(top);
    (void)children(middle);
    next_round();
    const std::uint32_t other = children(top + 7);
    const std::uint32_t under = children(other);
    (void)children(other + 1);
    EXPECT_EQ(tree().node(top).children, 0U);
    EXPECT_EQ(tree().node(top + 7).children, other);
    EXPECT_EQ(tree().node(other).children, under);
    EXPECT_EQ(tree().counters().nodes_evicted, 2U);
    EXPECT_EQ(reached().blocks, 5);
}

TEST_F(TreeTest, NodePoolWithoutRoomForOnePathIsRefusedWithTheLeastSize) {
    const TreeShape shape = make_tree_shape(4, 16, 8192);
    std::size_t least = 0;
    try {
        const Tree tree(shape, 1, bytes_of_blocks(shape, 5), glm::uvec2(1));
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::usage);
        ASSERT_EQ(std::sscanf(error.way_out().c_str(), "give it at least %zu bytes", &least), 1)
            << error.way_out();
    }
    const Tree tree(shape, 1, least, glm::uvec2(1));
    EXPECT_LE(tree.size_bytes(), least);
    EXPECT_THROW(Tree(shape, 1, least - 1, glm::uvec2(1)), Error);
}

}  // namespace
}  // namespace cairn::renderer
