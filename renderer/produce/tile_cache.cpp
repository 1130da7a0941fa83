#include "renderer/produce/tile_cache.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/error.h"

namespace cairn::renderer {
namespace {

constexpr std::size_t most_words_known = 65536;

std::vector<TileQuery> bricks_first(std::span<const TileQuery> queries, const Tree& tree) {
    std::vector<TileQuery> sorted(queries.begin(), queries.end());
    const auto place = [&](const TileQuery& query) {
        return std::tuple(query.kind == QueryKind::children, -tree.tile(query.entry).level, query.entry);
    };
    std::sort(sorted.begin(), sorted.end(),
              [&](const TileQuery& a, const TileQuery& b) { return place(a) < place(b); });
    return sorted;
}

/// Sorts queries: those of most rays first, and among equals the coarsest tiles first.
std::vector<TileQuery> most_rays_first(std::span<const TileQuery> queries, const Tree& tree) {
    std::vector<TileQuery> sorted(queries.begin(), queries.end());
    const auto level = [&](const TileQuery& query) { return tree.tile(query.entry).level; };
    std::sort(sorted.begin(), sorted.end(), [&](const TileQuery& a, const TileQuery& b) {
        return std::tuple(b.rays, level(a), a.entry, a.kind) < std::tuple(a.rays, level(b), b.entry, b.kind);
    });
    return sorted;
}

}  // namespace

TileCache::TileCache(std::unique_ptr<Content> content, const PoolSizes& sizes)
    : content_(std::move(content)),
      pool_(content_->shape(), content_->channels(), sizes.brick_bytes),
      tree_(content_->shape(), pool_.slot_count(), sizes.node_bytes, content_->oracle().child_mask(Tile{}),
            content_->has_constant()) {
    tree_.tell_of_free_slots([this](int slot) { pool_.release(slot); });
    pool_.make_room_by([this](int slot) { return evict_for(slot); });
    if (sizes.cache_bytes == 0) return;
    if (content_->has_low_frequency()) {
        throw Error(Fault::usage, "brick cache", "it does not record which tiles of this content are final",
                    "leave it out");
    }
    cache_.emplace(content_->shape(), pool_, sizes.cache_bytes);
    tree_.record_evictions(true);
}

TileCache::Answer TileCache::answer(std::span<const TileQuery> queries) {
    const auto start = Clock::now();
    Answer answer;
    for (const TileQuery& query : bricks_first(queries, tree_))
        settle(query, true, answer);
    const auto before_bricks = Clock::now();
    answer.bricks -= produce_requests();
    counted_.tile_queries += queries.size();
    counted_.tree_ms += milliseconds(before_bricks - start);
    return answer;
}

TileCache::Answer TileCache::answer_until(std::span<const TileQuery> queries, const Budget& budget) {
    const std::vector<TileQuery> urgent = most_rays_first(queries, tree_);
    counted_.tile_queries += queries.size();
    Answer all;
    auto next = urgent.begin();
    for (bool in_any_case = budget.first_batch_in_any_case; next != urgent.end(); in_any_case = false) {
        const auto start = Clock::now();
        if (start > budget.deadline && !in_any_case) break;
        const std::size_t batch = pace_.batch(milliseconds(budget.deadline - start));
        const std::size_t before = all.count();
        for (; next != urgent.end() && all.count() - before < batch; ++next)
            settle(*next, next->kind != QueryKind::stand_in && !budget.is_prefetch, all);
        all.bricks -= produce_requests();
        glFinish();
        pace_.learn(milliseconds_since(start), all.count() - before);
    }
    return all;
}

/// Gives the tile children, or a slot that produce_requests() fills, if the tile still lacks it.
/// @param may_stay  as in Tree::add_brick().
void TileCache::settle(const TileQuery& query, bool may_stay, Answer& answer) {
    const bool for_children = query.kind == QueryKind::children;
    if (for_children && !tree_.wants_children(query.entry)) return;
    // If only the tile's own brick decides whether anything finer would show, the brick comes first.
    const bool needs_brick =
        !for_children || (content_->has_low_frequency() && !tree_.was_produced(query.entry));
    if (needs_brick) {
        if (!tree_.wants_brick(query.entry)) return;
        const bool has_room = request(query.entry, may_stay);
        (has_room ? answer.bricks : answer.refused) += 1;
    } else if (subdivide(query.entry)) {
        answer.parents.push_back(query.entry);
    } else {
        ++answer.refused;
    }
}

bool TileCache::subdivide(std::uint32_t entry) {
    const std::optional<std::uint32_t> first = tree_.add_children(entry);
    if (!first) return false;
    ++counted_.nodes_subdivided;
    Oracle& oracle = content_->oracle();
    const int n = shape().n;
    const Tile tile = tree_.tile(entry);
    const glm::uvec2 mask = oracle.child_mask(tile);
    for (int child = 0; child < shape().child_count(); ++child) {
        if (!may_hold(mask, n, child)) continue;
        const Tile child_tile = child_of(tile, n, child);
        const std::uint32_t child_entry = *first + std::uint32_t(child);
        if (n == 8 && oracle.is_empty(child_tile)) {
            tree_.set_constant(child_entry, glm::u8vec4(0));
            tree_.set_final(child_entry);
        } else {
            tree_.set_child_mask(child_entry, oracle.child_mask(child_tile));
        }
    }
    return true;
}

/// Gives the tile a slot, if there is one, to be filled by produce_requests().
bool TileCache::request(std::uint32_t entry, bool may_stay) {
    if (!may_stay && lacks_room_) return false;
    const std::optional<int> slot = tree_.add_brick(entry, may_stay);
    if (!slot) {
        lacks_room_ = lacks_room_ || may_stay;
        return false;
    }
    // Before the slot gets other room: the brick that had to go is still where the slot's was.
    if (cache_) cache_->store(tree_.take_evicted());
    if (!expect_room(*slot, tree_.tile(entry))) {
        tree_.take_brick_back(entry);
        lacks_room_ = lacks_room_ || may_stay;
        return false;
    }
    requests_.push_back({tree_.tile(entry), *slot});
    requested_entries_.push_back(entry);
    return true;
}

/// Makes room for what a packed brick takes, if that is known, or else for what one takes on average: so few
/// are produced that then find no room, and none of them twice.
bool TileCache::expect_room(int slot, const Tile& tile) {
    const PackedBricks* const packed = pool_.packed();
    if (packed == nullptr) return true;
    const auto known = words_without_room_.find(tile);
    if (known != words_without_room_.end()) return pool_.reserve(slot, known->second);
    const std::size_t mean = packed->mean_words();
    while (expected_words_ + mean > packed->free_words()) {
        if (!evict_for(slot)) return false;
    }
    expected_words_ += mean;
    return true;
}

/// Evicts a brick whose room a slot may have.
bool TileCache::evict_for(int slot) {
    if (!tree_.evict_brick_for(slot)) return false;
    if (cache_) cache_->store(tree_.take_evicted());
    return true;
}

/// Restores the requested bricks that main memory holds.
/// @return  how many found no room.
std::size_t TileCache::restore_requests() {
    cache_->store(tree_.take_evicted());
    const auto start = Clock::now();
    std::vector<BrickRequest> unknown;
    std::vector<std::uint32_t> unknown_entries;
    std::size_t without_room = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        const BrickCache::Restored restored = cache_->restore(requests_[i].tile, requests_[i].slot);
        if (restored == BrickCache::Restored::no_room) {
            tree_.take_brick_back(requested_entries_[i]);
            ++without_room;
        }
        if (restored != BrickCache::Restored::not_cached) continue;
        unknown.push_back(requests_[i]);
        unknown_entries.push_back(requested_entries_[i]);
    }
    requests_ = std::move(unknown);
    requested_entries_ = std::move(unknown_entries);
    counted_.upload_ms += milliseconds_since(start);
    return without_room;
}

/// Fills the requested slots: with bricks from main memory if it holds them, else with produced ones.
/// @return  how many found no room.
std::size_t TileCache::produce_requests() {
    expected_words_ = 0;
    std::size_t without_room = cache_ ? restore_requests() : 0;
    const std::vector<ProducedTile> found = content_->producer().produce(requests_, pool_);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::uint32_t entry = requested_entries_[i];
        if (found[i].words_without_room != 0) {  // the rays ask again in the next round
            if (words_without_room_.size() >= most_words_known) words_without_room_.clear();
            words_without_room_[tree_.tile(entry)] = found[i].words_without_room;
            tree_.take_brick_back(entry);
            ++without_room;
            continue;
        }
        if (content_->has_low_frequency()) tree_.set_produced(entry);
        if (found[i].low_frequency) tree_.set_final(entry);
        if (!found[i].constant) continue;
        tree_.set_constant(entry, found[i].mean);
        ++counted_.constant_tiles;
    }
    counted_.bricks_produced += requests_.size();
    counted_.upload_ms += content_->producer().upload_ms();
    requests_.clear();
    requested_entries_.clear();
    return without_room;
}

void TileCache::upload() {
    const auto start = Clock::now();
    tree_.upload();
    pool_.upload();
    counted_.upload_ms += milliseconds_since(start);
}

bool TileCache::is_empty() const {
    return shape().max_level > 0 && tree_.node(0).child_mask == glm::uvec2(0);
}

TileCache::Counters TileCache::counters() const {
    Counters all = counted_;
    all.bricks_evicted = tree_.counters().bricks_evicted;
    all.nodes_evicted = tree_.counters().nodes_evicted;
    all.bricks_relinked = tree_.counters().bricks_relinked;
    if (cache_) {
        all.bricks_cached = cache_->counters().stored;
        all.bricks_restored = cache_->counters().restored;
    }
    return all;
}

TileCache::Counters TileCache::Counters::operator-(const Counters& before) const {
    return {.tile_queries = tile_queries - before.tile_queries,
            .nodes_subdivided = nodes_subdivided - before.nodes_subdivided,
            .bricks_produced = bricks_produced - before.bricks_produced,
            .constant_tiles = constant_tiles - before.constant_tiles,
            .bricks_evicted = bricks_evicted - before.bricks_evicted,
            .nodes_evicted = nodes_evicted - before.nodes_evicted,
            .bricks_relinked = bricks_relinked - before.bricks_relinked,
            .bricks_cached = bricks_cached - before.bricks_cached,
            .bricks_restored = bricks_restored - before.bricks_restored,
            .tree_ms = tree_ms - before.tree_ms,
            .upload_ms = upload_ms - before.upload_ms};
}

}  // namespace cairn::renderer
