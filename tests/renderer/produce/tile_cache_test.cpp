// The tile cache alone, with queries that tests make.
#include "renderer/produce/tile_cache.h"

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/error.h"
#include "renderer/pool/brick_pool.h"
#include "shaders/interop/pool.h"
#include "tests/support/box_content.h"
#include "tests/support/gl_fixture.h"

namespace cairn::test {
namespace {

using renderer::QueryKind;
using renderer::Round;
using renderer::Tile;
using renderer::TileCache;
using renderer::TileQuery;
using renderer::TreeShape;

class TileCacheTest : public GlTest {
protected:
    /// N = 4, M = 8, and three levels under the root.
    static TreeShape shape() { return renderer::make_tree_shape(4, 8, 512); }

    static std::size_t bytes_of_slots(int slots) {
        const renderer::BrickPool sample(shape(), true, 1U << 20U);
        return std::size_t(slots) * (sample.size_bytes() / std::size_t(sample.slot_count()));
    }
    /// Bytes of node blocks, without the means of constant tiles.
    static std::size_t bytes_of_blocks(int blocks) {
        return std::size_t(blocks) * std::size_t(shape().child_count()) * sizeof(interop::NodeEntry);
    }

    TileCache& make(const renderer::PoolSizes& sizes = {.brick_bytes = 8U << 20U},
                    const BoxOptions& options = {.constant = false}) {
        auto content = std::make_unique<BoxContent>(shape(), options);
        content_ = content.get();
        cache_ = std::make_unique<TileCache>(std::move(content), sizes);
        round_ = Round{};
        next_round();
        return *cache_;
    }
    /// A round whose rays used these bricks.
    void next_round(const std::vector<int>& used_slots = {}) {
        std::vector<std::uint32_t> stamps(std::size_t(cache_->pool().slot_count()), 0);
        for (const int slot : used_slots)
            stamps[std::size_t(slot)] = round_.number;
        round_ = round_.next();
        cache_->begin_round(round_, stamps);
    }
    /// Entries of a tile's children that are not empty, in a round of their own.
    std::vector<std::uint32_t> children_of(std::uint32_t entry) {
        const TileQuery query{entry, QueryKind::children};
        EXPECT_EQ(cache_->answer({&query, 1}).parents, std::vector{entry});
        next_round();
        std::vector<std::uint32_t> full;
        const renderer::Tree& tree = cache_->tree();
        for (int child = 0; child < shape().child_count(); ++child) {
            if (renderer::may_hold(tree.node(entry).child_mask, shape().n, child))
                full.push_back(tree.node(entry).children + std::uint32_t(child));
        }
        return full;
    }
    static std::vector<TileQuery> for_bricks(const std::vector<std::uint32_t>& entries) {
        std::vector<TileQuery> queries;
        for (const std::uint32_t entry : entries)
            queries.push_back({entry, QueryKind::brick});
        return queries;
    }
    [[nodiscard]] const std::vector<Tile>& produced() const { return content_->produced(); }
    [[nodiscard]] Tile tile(std::uint32_t entry) const { return cache_->tree().tile(entry); }
    [[nodiscard]] bool has_brick(std::uint32_t entry) const { return cache_->tree().slot(entry).has_value(); }
    [[nodiscard]] Round round() const { return round_; }

private:
    std::unique_ptr<TileCache> cache_;
    BoxContent* content_ = nullptr;
    Round round_;
};

TEST_F(TileCacheTest, AnswersWithoutAnyRay) {
    TileCache& cache = make();
    const std::vector<TileQuery> root = {{0, QueryKind::children}, {0, QueryKind::brick}};
    const TileCache::Answer answer = cache.answer(root);
    EXPECT_EQ(answer.parents, std::vector<std::uint32_t>{0});
    EXPECT_EQ(answer.bricks, 1U);
    EXPECT_EQ(produced(), std::vector{Tile{}});
    EXPECT_TRUE(has_brick(0));
    const std::uint32_t first = cache.tree().node(0).children;
    ASSERT_NE(first, 0U);
    const glm::uvec2 mask = cache.content().oracle().child_mask(Tile{});
    for (int child = 0; child < shape().child_count(); ++child) {
        const std::uint32_t entry = first + std::uint32_t(child);
        const glm::uvec2 expected = renderer::may_hold(mask, shape().n, child)
                                        ? cache.content().oracle().child_mask(tile(entry))
                                        : glm::uvec2(0);
        EXPECT_EQ(cache.tree().node(entry).child_mask, expected) << "child " << child;
    }
    const TileCache::Counters counters = cache.counters();
    EXPECT_EQ(counters.tile_queries, 2U);
    EXPECT_EQ(counters.nodes_subdivided, 1U);
    EXPECT_EQ(counters.bricks_produced, 1U);
}

TEST_F(TileCacheTest, TellsOnlyTheEntriesThatGotChildren) {
    TileCache& cache = make();
    const std::vector<std::uint32_t> level1 = children_of(0);
    const std::vector<std::uint32_t> level2 = children_of(level1[1]);
    const std::vector<std::uint32_t> level3 = children_of(level2[0]);
    EXPECT_EQ(tile(level3[0]).level, shape().max_level);
    const std::vector<TileQuery> queries = {
        {0, QueryKind::children},          // has some
        {level3[0], QueryKind::children},  // can have none
        {level1[2], QueryKind::children}, {level2[1], QueryKind::children},
        {level2[2], QueryKind::brick},    {level2[1], QueryKind::children},  // asked twice
    };
    const TileCache::Answer answer = cache.answer(queries);
    EXPECT_EQ(answer.parents, (std::vector{level2[1], level1[2]}));
    EXPECT_EQ(answer.bricks, 1U);
    EXPECT_EQ(cache.counters().tile_queries, 3U + queries.size());
    // Rays of this round have not queried what was produced in it.
    const TileQuery newborn{cache.tree().node(level1[2]).children, QueryKind::children};
    EXPECT_EQ(cache.answer({&newborn, 1}).count(), 0U);
}

TEST_F(TileCacheTest, ProducesTheDeepestTilesFirst) {
    TileCache& cache = make();
    const std::vector<std::uint32_t> level1 = children_of(0);
    const std::vector<std::uint32_t> level2 = children_of(level1[0]);
    EXPECT_EQ(cache.answer(for_bricks({0, level1[1], level2[0], level1[0]})).bricks, 4U);
    EXPECT_EQ(produced(), (std::vector{tile(level2[0]), tile(level1[0]), tile(level1[1]), Tile{}}));
}

TEST_F(TileCacheTest, BricksComeFirstAndThenTheDeepestNodes) {
    // Blocks for the root, its children, those of two of them, and of one of theirs: then there is no room.
    for (const bool asks_for_brick : {true, false}) {
        SCOPED_TRACE(asks_for_brick);
        TileCache& cache = make({.node_bytes = bytes_of_blocks(5), .brick_bytes = bytes_of_slots(8)});
        const std::vector<std::uint32_t> level1 = children_of(0);
        const std::vector<std::uint32_t> one = children_of(level1[0]);
        const std::vector<std::uint32_t> inner = children_of(one[0]);
        const std::vector<std::uint32_t> other = children_of(level1[1]);
        // Nodes that lead to a brick stay. Of the others, only the block of `inner` can be evicted if rays
        // are in `other`.
        const Round kept = round();
        EXPECT_EQ(cache.answer(for_bricks({one[1]})).bricks, 1U);
        next_round();
        cache.keep_since(kept);
        std::vector<TileQuery> queries = {{level1[2], QueryKind::children}, {other[0], QueryKind::children}};
        if (asks_for_brick) queries.push_back({inner[0], QueryKind::brick});
        const TileCache::Answer answer = cache.answer(queries);
        if (asks_for_brick) {
            EXPECT_EQ(answer.bricks, 1U);
            EXPECT_TRUE(has_brick(inner[0]));
            EXPECT_TRUE(answer.parents.empty()) << "a node took the place of a brick's";
        } else {
            EXPECT_EQ(answer.parents, std::vector{other[0]});
            EXPECT_EQ(cache.counters().nodes_evicted, 1U);
        }
    }
}

TEST_F(TileCacheTest, FullPoolAnswersWhatFitsAndTheRestLater) {
    TileCache& cache = make({.brick_bytes = bytes_of_slots(3)});
    ASSERT_EQ(cache.pool().slot_count(), 3);
    const std::vector<std::uint32_t> level1 = children_of(0);
    const std::vector<TileQuery> queries = for_bricks({level1[0], level1[1], level1[2], level1[3]});
    EXPECT_EQ(cache.answer(queries).bricks, 3U);
    EXPECT_FALSE(has_brick(level1[3]));
    EXPECT_EQ(cache.answer(queries).bricks, 0U) << "what this round was given is not taken away in it";
    EXPECT_EQ(cache.counters().bricks_evicted, 0U);

    const int kept = cache.tree().slot(level1[1]).value();
    next_round({kept});
    next_round({kept});
    EXPECT_EQ(cache.answer(for_bricks({level1[3]})).bricks, 1U);
    EXPECT_TRUE(has_brick(level1[1])) << "the one that rays used last went";
    EXPECT_EQ(cache.counters().bricks_evicted, 1U);
    EXPECT_EQ(cache.counters().bricks_produced, 4U);
}

TEST_F(TileCacheTest, KeepsWhatWasUsedSinceARoundUntilToldOtherwise) {
    TileCache& cache = make({.brick_bytes = bytes_of_slots(2)});
    const std::vector<std::uint32_t> level1 = children_of(0);
    const Round first_used = round();
    EXPECT_EQ(cache.answer(for_bricks({level1[0], level1[1]})).bricks, 2U);
    const auto answered = [&](std::optional<Round> kept, std::uint32_t entry) {
        cache.keep_since(kept);
        next_round();
        return cache.answer(for_bricks({entry})).bricks;
    };
    EXPECT_EQ(answered(first_used, level1[2]), 0U);
    EXPECT_EQ(answered(first_used.next(), level1[2]), 1U);
    EXPECT_EQ(answered(first_used, level1[3]), 0U);
    EXPECT_EQ(answered(std::nullopt, level1[3]), 1U);
}

TEST_F(TileCacheTest, WhenTimeIsUpOnlyTheFirstBatchIsAnswered) {
    TileCache& cache = make();
    const std::vector<std::uint32_t> level1 = children_of(0);
    std::vector<TileQuery> queries = for_bricks({level1.begin(), level1.begin() + 12});
    for (std::size_t i = 0; i < queries.size(); ++i)
        queries[i].rays = std::uint32_t(i * 5 % 12);
    const Clock::time_point past = Clock::now() - std::chrono::seconds(1);
    EXPECT_EQ(cache.answer_until(queries, {.deadline = past}).count(), 0U);
    EXPECT_TRUE(produced().empty());
    const TileCache::Answer late =
        cache.answer_until(queries, {.deadline = past, .first_batch_in_any_case = true});
    EXPECT_EQ(late.count(), renderer::BatchPace::least);
    // 5 i = 11, 10, 9, 8 mod 12.
    EXPECT_EQ(produced(), (std::vector{tile(level1[7]), tile(level1[2]), tile(level1[9]), tile(level1[4])}))
        << "most rays did not come first";

    next_round();
    const Clock::time_point far = Clock::now() + std::chrono::hours(1);
    EXPECT_EQ(cache.answer_until(queries, {.deadline = far}).count(), queries.size() - late.count());
    EXPECT_EQ(cache.counters().tile_queries, 1U + 3U * queries.size());
}

TEST_F(TileCacheTest, AheadNothingThatIsKeptLosesItsPlace) {
    TileCache& cache = make({.brick_bytes = bytes_of_slots(3)});
    const std::vector<std::uint32_t> level1 = children_of(0);
    EXPECT_EQ(cache.answer(for_bricks({level1[0]})).bricks, 1U);
    next_round();
    next_round();
    const Round frame = round();
    EXPECT_EQ(cache.answer(for_bricks({level1[1]})).bricks, 1U);
    next_round();
    cache.keep_since(frame);
    const Clock::time_point far = Clock::now() + std::chrono::hours(1);
    const TileCache::Budget ahead{.deadline = far, .is_prefetch = true};
    // One free slot, and one whose brick is older than the frame.
    EXPECT_EQ(cache.answer_until(for_bricks({level1[2], level1[3], level1[4]}), ahead).bricks, 2U);
    EXPECT_TRUE(has_brick(level1[1]));
    EXPECT_FALSE(has_brick(level1[0]));
    next_round();
    EXPECT_EQ(cache.answer_until(for_bricks({level1[0], level1[4]}), ahead).bricks, 0U)
        << "bricks of the future take turns";
    EXPECT_EQ(cache.answer(for_bricks({level1[0]})).bricks, 1U) << "a frame has to wait for the future";
    EXPECT_TRUE(has_brick(level1[1]));
}

TEST_F(TileCacheTest, TileThatMayBeFinalIsProducedBeforeItIsSubdivided) {
    TileCache& cache = make({.brick_bytes = 8U << 20U}, {.constant = false, .low_frequency = true});
    const TileQuery query{0, QueryKind::children};
    const TileCache::Answer brick = cache.answer({&query, 1});
    EXPECT_TRUE(brick.parents.empty());
    EXPECT_EQ(brick.bricks, 1U);
    next_round();
    const std::vector<std::uint32_t> level1 = children_of(0);  // the root is not final
    // Tiles in the low half along x are.
    for (int time = 0; time < 2; ++time) {
        std::vector<TileQuery> queries;
        for (const std::uint32_t entry : level1)
            queries.push_back({entry, QueryKind::children});
        const TileCache::Answer answer = cache.answer(queries);
        EXPECT_EQ(answer.bricks, time == 0 ? level1.size() : 0U);
        for (const std::uint32_t entry : answer.parents)
            EXPECT_GE(tile(entry).position.x, 2) << "a final tile was subdivided";
        EXPECT_EQ(answer.parents.empty(), time == 0);
        next_round();
    }
}

TEST_F(TileCacheTest, RefusesMainMemoryForTilesThatMayBeFinal) {
    const renderer::PoolSizes sizes{.brick_bytes = 8U << 20U, .cache_bytes = 8U << 20U};
    EXPECT_NO_THROW(make(sizes));
    EXPECT_THROW(make(sizes, {.low_frequency = true}), Error);
}

}  // namespace
}  // namespace cairn::test
