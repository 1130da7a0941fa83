#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/clock.h"
#include "renderer/pool/brick_cache.h"
#include "renderer/pool/brick_pool.h"
#include "renderer/pool/pool_sizes.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree.h"
#include "renderer/produce/batch_pace.h"
#include "renderer/produce/content.h"
#include "renderer/produce/tile_query.h"

namespace cairn::renderer {

/// The tiles of a content that are there to be marched, and the way to those that are not: it answers tile
/// queries, whoever asks (Crassin et al. 2008, sections 4 and 6). Queries are those of one round: an entry
/// that has since been given to another tile is left alone.
class TileCache {
public:
    /// @throws Error (Fault::usage) for a pool that is too small to work, and for main memory behind a pool
    /// of content whose final tiles it could not tell (Content::has_low_frequency()).
    TileCache(std::unique_ptr<Content> content, const PoolSizes& sizes);
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;
    TileCache(TileCache&&) = delete;
    TileCache& operator=(TileCache&&) = delete;
    ~TileCache() = default;

    /// What queries brought.
    struct Answer {
        std::vector<std::uint32_t> parents;  ///< entries that got children
        std::size_t bricks = 0;              ///< tiles that got a slot for their brick
        [[nodiscard]] std::size_t count() const { return parents.size() + bricks; }
    };

    /// Answers queries as far as there is room. Bricks come first, then the deepest nodes: whatever the
    /// pools' sizes, the ray that is nearest to its data gets it, so every pass brings some ray forward.
    Answer answer(std::span<const TileQuery> queries);

    struct Budget {
        Clock::time_point deadline;
        bool first_batch_in_any_case = false;  ///< though there be no time
        bool is_ahead = false;  ///< of frames to come: nothing that keep_since() keeps loses its place
    };
    /// Answers queries until time is up, what most rays ask for first, in batches that end soon after it.
    Answer answer_until(std::span<const TileQuery> queries, const Budget& budget);

    /// Gives a tile children, though nobody has asked. @return false: there is no room.
    bool subdivide(std::uint32_t entry);

    /// Sends the nodes that changed to the GPU; before rays march again.
    void upload();

    /// As of Tree.
    void begin_round(Round round, const std::vector<std::uint32_t>& brick_stamps) {
        tree_.begin_round(round, brick_stamps);
    }
    void keep_since(std::optional<Round> round) { tree_.keep_since(round); }

    /// Nothing in the whole content: known without a ray. (A tree of one level has no children to tell it.)
    [[nodiscard]] bool is_empty() const;

    /// Since the cache was made.
    struct Counters {
        std::uint64_t tile_queries = 0;
        std::uint64_t nodes_subdivided = 0;
        std::uint64_t bricks_produced = 0;
        std::uint64_t constant_tiles = 0;  ///< of those: turned out to hold one value, and keep no brick
        std::uint64_t bricks_evicted = 0;
        std::uint64_t nodes_evicted = 0;
        std::uint64_t bricks_relinked = 0;  ///< still in the pool when their node came back
        std::uint64_t bricks_cached = 0;    ///< read back into main memory when they had to leave the pool
        std::uint64_t bricks_restored = 0;  ///< taken from main memory instead of produced
        double tree_ms = 0.0;               ///< of answer(): neither bricks nor uploading
        double upload_ms = 0.0;             ///< sending to the GPU what is made or kept in main memory

        Counters operator-(const Counters& before) const;
    };
    [[nodiscard]] Counters counters() const;

    [[nodiscard]] const TreeShape& shape() const { return tree_.shape(); }
    [[nodiscard]] Content& content() const { return *content_; }
    [[nodiscard]] const BrickPool& pool() const { return pool_; }
    [[nodiscard]] const Tree& tree() const { return tree_; }
    /// For those who subdivide it by a plan of their own.
    [[nodiscard]] Tree& tree() { return tree_; }
    /// Of main memory, now.
    [[nodiscard]] std::size_t brick_cache_bytes() const { return cache_ ? cache_->size_bytes() : 0; }

private:
    void settle(const TileQuery& query, bool may_stay, Answer& answer);
    [[nodiscard]] bool request(std::uint32_t entry, bool may_stay);
    void restore_requests();
    void produce_requests();

    std::unique_ptr<Content> content_;
    BrickPool pool_;
    Tree tree_;
    std::optional<BrickCache> cache_;
    BatchPace pace_;
    std::vector<BrickRequest> requests_;  // that wait to be produced together
    std::vector<std::uint32_t> requested_entries_;
    Counters counted_;  // but for what the tree and the brick cache count themselves
};

}  // namespace cairn::renderer
