#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/clock.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree.h"
#include "renderer/pool/tree_shape.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/produce/content.h"
#include "renderer/produce/tile_query.h"

namespace cairn::renderer {

/// The tiles of a content that are ready to be marched. It produces missing ones by answering tile queries
/// (Crassin et al. 2008, sections 4 and 6). Queries belong to one round: an entry that has been given to
/// another tile since is left alone.
class TileCache {
public:
    /// @throws Error (Fault::usage) if a pool is too small, or if bricks shall be kept in main memory
    ///                              (PoolSizes::cache_bytes) for a content with final tiles
    ///                              (Content::has_low_frequency()), which are not recorded there.
    TileCache(std::unique_ptr<Content> content, const PoolSizes& sizes);
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;
    TileCache(TileCache&&) = delete;
    TileCache& operator=(TileCache&&) = delete;
    ~TileCache() = default;

    /// What the answers to some queries changed.
    struct Answer {
        std::vector<std::uint32_t> parents;  ///< entries that got children
        std::size_t bricks = 0;              ///< tiles that got a slot for their brick
        std::size_t refused = 0;             ///< queries that found no room
        [[nodiscard]] std::size_t count() const { return parents.size() + bricks; }
    };

    /// Answers queries as far as there is room. Bricks come first, then the deepest nodes: whatever the sizes
    /// of the pools, the ray that is nearest to its data gets it, so every pass brings at least one ray
    /// forward.
    Answer answer(std::span<const TileQuery> queries);

    struct Budget {
        Clock::time_point deadline;
        /// The first batch is answered even if the deadline has passed.
        bool first_batch_in_any_case = false;
        /// The answers are for frames to come: they replace nothing that keep_since() keeps.
        bool is_prefetch = false;
    };
    /// Answers queries until the deadline, in batches; those of most rays come first. The last batch ends
    /// soon after the deadline.
    Answer answer_until(std::span<const TileQuery> queries, const Budget& budget);

    /// Gives a tile children without a query.
    /// @return  false if there is no room.
    bool subdivide(std::uint32_t entry);

    /// Sends the nodes that changed, and the places of new bricks, to the GPU. Call it before rays march
    /// again.
    void upload();

    /// Tree::begin_round().
    void begin_round(Round round, const std::vector<std::uint32_t>& brick_stamps) {
        tree_.begin_round(round, brick_stamps);
    }
    /// Tree::keep_since().
    void keep_since(std::optional<Round> round) {
        if (round != kept_since_) lacks_room_ = false;
        kept_since_ = round;
        tree_.keep_since(round);
    }

    /// Is the whole content certainly empty? Always false for a tree of one level, whose root has no child
    /// mask.
    [[nodiscard]] bool is_empty() const;

    /// Counters since the cache was made.
    struct Counters {
        std::uint64_t tile_queries = 0;
        std::uint64_t nodes_subdivided = 0;
        std::uint64_t bricks_produced = 0;
        /// Produced tiles that turned out to hold one value, and keep no brick.
        std::uint64_t constant_tiles = 0;
        std::uint64_t bricks_evicted = 0;
        std::uint64_t nodes_evicted = 0;
        /// Bricks that were still in the pool when their node came back.
        std::uint64_t bricks_relinked = 0;
        /// Bricks read back into main memory when they had to leave the pool.
        std::uint64_t bricks_cached = 0;
        /// Bricks taken from main memory instead of produced.
        std::uint64_t bricks_restored = 0;
        /// Time of answer() in the tree, without bricks and uploading.
        double tree_ms = 0.0;
        /// Time to send to the GPU what main memory makes or keeps.
        double upload_ms = 0.0;

        Counters operator-(const Counters& before) const;
    };
    [[nodiscard]] Counters counters() const;

    [[nodiscard]] const TreeShape& shape() const { return tree_.shape(); }
    [[nodiscard]] Content& content() const { return *content_; }
    [[nodiscard]] const BrickPool& pool() const { return pool_; }
    [[nodiscard]] const Tree& tree() const { return tree_; }
    /// For callers that subdivide the tree by a plan of their own.
    [[nodiscard]] Tree& tree() { return tree_; }
    /// Bytes of the bricks in main memory now.
    [[nodiscard]] std::size_t brick_cache_bytes() const { return cache_ ? cache_->size_bytes() : 0; }

private:
    void settle(const TileQuery& query, bool may_stay, Answer& answer);
    [[nodiscard]] bool request(std::uint32_t entry, bool may_stay);
    bool evict_for(int slot);
    [[nodiscard]] bool expect_room(int slot, const Tile& tile);
    [[nodiscard]] std::size_t restore_requests();
    [[nodiscard]] std::size_t produce_requests();

    std::unique_ptr<Content> content_;
    BrickPool pool_;
    Tree tree_;
    std::optional<BrickCache> cache_;
    BatchPace pace_;
    std::vector<BrickRequest> requests_;  // requests that wait to be produced together
    std::vector<std::uint32_t> requested_entries_;
    std::size_t expected_words_ = 0;  // of their packed bricks
    std::optional<Round> kept_since_;
    /// A brick that may stay found no room since then. What went in vain for it leaves room; bricks that may
    /// not stay must not take that, or they would go for it again, without end.
    bool lacks_room_ = false;
    /// Words of packed bricks that found no room, so that they are not produced in vain again.
    std::unordered_map<Tile, std::uint32_t, TileHash> words_without_room_;
    Counters counted_;  // without those that the tree and the brick cache count
};

}  // namespace cairn::renderer
