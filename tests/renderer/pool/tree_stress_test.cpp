// Thousands of random rounds of a tree in pools that are far too small, and the invariants after each round.
#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/pool/tree.h"
#include "shaders/interop/pool.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/lattice_surface.h"
#include "tests/support/tree_view.h"

namespace cairn::renderer {
namespace {

using namespace cairn::test;

struct Pools {
    int n, blocks, slots, max_resolution;
};

class TreeStress : public GlTest, public ::testing::WithParamInterface<Pools> {
protected:
    /// A query of a ray, and its tile.
    struct Query {
        std::uint32_t entry;
        bool brick;
        Tile tile;
    };

    void SetUp() override {
        GlTest::SetUp();
        const TreeShape shape = make_tree_shape_within(GetParam().n, 8, GetParam().max_resolution);
        tree_.emplace(shape, GetParam().slots, bytes_of_blocks(shape, GetParam().blocks), glm::uvec2(1));
        used_.resize(std::size_t(GetParam().slots), 0);
    }

    /// Rays go down at random, use the bricks that they meet, and query where they end.
    std::vector<Query> ask() {
        std::vector<Query> queries;
        for (int ray = 0; ray < 12; ++ray) {
            std::uint32_t entry = 0;
            while (tree_->node(entry).children != 0 && random_.between(0, 4) != 0) {
                const std::uint32_t first = tree_->node(entry).children;
                entry = first + std::uint32_t(random_.between(0, tree_->shape().child_count() - 1));
            }
            const std::uint32_t brick = tree_->node(entry).brick;
            if (brick != 0) used_[brick - 1] = round_;
            queries.push_back({entry, random_.between(0, 2) != 0, tree_->tile(entry)});
        }
        return queries;
    }

    void serve_brick(const Query& query) {
        const std::map<int, std::uint32_t> owners = owners_;
        const std::uint64_t evicted = tree_->counters().bricks_evicted;
        const std::optional<int> slot = tree_->add_brick(query.entry);
        std::uint32_t oldest = round_;
        for (const auto& [resident, owner] : owners)
            oldest = std::min(oldest, used_[std::size_t(resident)]);
        if (!slot) {
            ++refused_;
            EXPECT_EQ(owners.size(), used_.size()) << "refused beside a free slot";
            EXPECT_EQ(oldest, round_) << "refused beside an old brick";
            return;
        }
        ++bricks_added_;
        if (const auto taken = owners.find(*slot); taken != owners.end()) {
            EXPECT_EQ(owners.size(), used_.size()) << "a brick was taken although a slot was free";
            EXPECT_LT(used_[std::size_t(*slot)], round_) << "the brick was needed in this round";
            EXPECT_EQ(used_[std::size_t(*slot)], oldest) << "an older brick was there";
            if (taken->second != orphan) {
                EXPECT_EQ(tree_->node(taken->second).brick, 0U);
            }
            EXPECT_EQ(tree_->counters().bricks_evicted, evicted + 1);
        }
        used_[std::size_t(*slot)] = round_;
        owners_[*slot] = query.entry;
        this_round_.push_back(query);
    }

    void serve_children(const Query& query) {
        const std::optional<std::uint32_t> first = tree_->add_children(query.entry);
        if (!first) {
            ++refused_;
            return;
        }
        ++blocks_added_;
        tree_->set_child_mask(*first, glm::uvec2(std::uint32_t(random_.between(1, 255)), round_));
        this_round_.push_back(query);
        learn_owners();
    }

    /// The resident bricks, by the entries that are reached.
    void learn_owners() {
        owners_.clear();
        for (const std::uint32_t entry : walk(*tree_, GetParam().slots).entries) {
            if (tree_->node(entry).brick != 0) owners_[int(tree_->node(entry).brick) - 1] = entry;
        }
        for (const auto& [tile, held] : tree_->orphans()) {
            const int slot = held.slot;
            EXPECT_EQ(owners_.count(slot), 0U) << "the orphan in slot " << slot << " has an owner";
            owners_[slot] = orphan;
        }
    }

    void check() {
        const Reached reached = walk(*tree_, GetParam().slots);
        const Tree::Counters& counters = tree_->counters();
        EXPECT_EQ(std::uint64_t(reached.blocks), 1 + blocks_added_ - counters.nodes_evicted);
        EXPECT_LE(reached.blocks, GetParam().blocks);
        EXPECT_EQ(std::uint64_t(tree_->bricks_resident()), bricks_added_ - counters.bricks_evicted);
        EXPECT_EQ(reached.bricks + int(tree_->orphans().size()), tree_->bricks_resident());
        std::vector<bool> is_reached(tree_->entry_count(), false);
        for (const std::uint32_t entry : reached.entries)
            is_reached[entry] = true;
        for (const Query& query : this_round_) {
            EXPECT_TRUE(is_reached[query.entry])
                << "entry " << query.entry << " was given up in its own round";
            const interop::NodeEntry& node = tree_->node(query.entry);
            EXPECT_NE(query.brick ? node.brick : node.children, 0U)
                << "what entry " << query.entry << " got in this round is gone";
        }
    }

    void play_round() {
        const std::vector<Query> queries = ask();
        tree_->begin_round(renderer::Round{++round_}, used_);
        learn_owners();
        this_round_.clear();
        for (const Query& query : queries) {
            if (query.brick ? !tree_->wants_brick(query.entry) : !tree_->wants_children(query.entry))
                continue;
            EXPECT_EQ(tree_->tile(query.entry), query.tile)
                << "entry " << query.entry << " is another tile now";
            if (query.brick)
                serve_brick(query);
            else
                serve_children(query);
        }
        check();
    }

    static constexpr std::uint32_t orphan = 0xFFFFFFFFU;  ///< stands for an entry that is gone
    Random random_{20240607};
    std::optional<Tree> tree_;
    std::uint32_t round_ = 1;
    std::vector<std::uint32_t> used_;      ///< last round that used or filled each slot
    std::map<int, std::uint32_t> owners_;  ///< entry of each resident brick
    std::vector<Query> this_round_;        ///< queries answered in this round
    std::uint64_t blocks_added_ = 0;
    std::uint64_t bricks_added_ = 0;
    std::uint64_t refused_ = 0;
};

TEST_P(TreeStress, KeepsItsInvariants) {
    for (int round = 0; round < 1500 && !HasFailure(); ++round) {
        SCOPED_TRACE(fmt::format("seed 20240607, round {}", round_ + 1));
        play_round();
        if (round % 20 != 0) continue;
        tree_->upload();
        EXPECT_TRUE(gpu_equals_mirror(*tree_));
    }
    EXPECT_GT(blocks_added_, 1000U);
    EXPECT_GT(bricks_added_, 1000U);
    EXPECT_GT(tree_->counters().nodes_evicted, 900U);
    EXPECT_GT(tree_->counters().bricks_evicted, 900U);
    EXPECT_GT(refused_, 0U) << "the pools were never exhausted";
}

INSTANTIATE_TEST_SUITE_P(Pools, TreeStress,
                         ::testing::Values(Pools{2, 12, 6, 1024}, Pools{2, 60, 3, 512}, Pools{4, 7, 5, 4096}),
                         [](const auto& pools) {
                             return fmt::format("N{}Blocks{}Slots{}", pools.param.n, pools.param.blocks,
                                                pools.param.slots);
                         });

}  // namespace
}  // namespace cairn::renderer
