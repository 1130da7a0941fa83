#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gl/buffer.h"
#include "gl/handle.h"
#include "renderer/pool/lru.h"
#include "renderer/pool/round.h"
#include "renderer/pool/tree_shape.h"
#include "shaders/interop/pool.h"

namespace cairn::renderer {

/// The N^3-tree: the node pool on the GPU, its mirror on the CPU, and which node owns which slot of the brick
/// pool (Crassin et al. 2008, sections 4.2 and 4.3).
///
/// The node pool is an array of NodeEntry in blocks of n^3: the children of one tile. Block 0 holds the root
/// alone, in its entry 0. Both stores are bounded. They recycle the block or the slot that was not used for
/// longest, and never one that was given out or pinned in the current round; a parent outlives its children.
/// When a node is evicted, its brick stays in its slot as an orphan until the slot itself is evicted; if the
/// tile comes back before that, the brick is linked again.
class Tree {
public:
    /// @param root_mask  child_mask of the root tile.
    /// @param has_means  tiles may be constant without being empty: then their values are kept beside the
    ///                   entries.
    /// @throws Error (Fault::usage) if `node_pool_bytes` has no room for the blocks of one path from the root
    ///                              to a leaf.
    Tree(const TreeShape& shape, int brick_slots, std::size_t node_pool_bytes, glm::uvec2 root_mask,
         bool has_means = false);

    [[nodiscard]] const TreeShape& shape() const { return shape_; }
    [[nodiscard]] const Tile& tile(std::uint32_t entry) const { return tiles_[entry]; }
    /// The mirror of an entry, as the next upload() leaves it on the GPU.
    [[nodiscard]] const interop::NodeEntry& node(std::uint32_t entry) const { return entries_[entry]; }
    [[nodiscard]] std::uint32_t entry_count() const { return std::uint32_t(entries_.size()); }
    /// Slot of the entry's brick in the pool; none if the entry has no brick.
    [[nodiscard]] std::optional<int> slot(std::uint32_t entry) const {
        const std::uint32_t number = entries_[entry].brick & NODE_SLOT;
        return number != 0 ? std::optional(int(number) - 1) : std::nullopt;
    }
    [[nodiscard]] std::size_t size_bytes() const {
        return node_buffer_.size_bytes() + mean_buffer_.size_bytes();
    }
    /// Bricks in the pool, orphans included.
    [[nodiscard]] int bricks_resident() const { return bricks_.used_count(); }
    /// Bricks, without orphans, that were given a slot or used by rays in that round or later.
    [[nodiscard]] int bricks_used_since(Round round) const;

    /// A brick whose node was evicted.
    struct OrphanBrick {
        int slot = 0;
        std::uint32_t flags = 0;  ///< NODE_* flags that the node had
    };
    [[nodiscard]] const std::unordered_map<Tile, OrphanBrick, TileHash>& orphans() const { return orphans_; }

    /// Starts a round. Stamps the bricks that rays used in the pass before it, and the ancestors of their
    /// tiles.
    /// @param brick_stamps  the last round whose rays used the brick, one per slot.
    void begin_round(Round round, const std::vector<std::uint32_t>& brick_stamps);

    /// Until the next call, evicts nothing that rays used in that round or later. None: everything that the
    /// current round did not use may be evicted.
    void keep_since(std::optional<Round> round) { keep_since_ = round; }

    /// Does the entry still lack children, or a brick? An earlier answer of the round, or an eviction, may
    /// have settled the query.
    [[nodiscard]] bool wants_children(std::uint32_t entry) const;
    [[nodiscard]] bool wants_brick(std::uint32_t entry) const;

    /// Makes room for the children of a tile. The caller calls set_child_mask() for each child that is not
    /// empty.
    /// @return  entry of the first child; none if every block is in use in this round (the ray asks again in
    ///          the next round).
    [[nodiscard]] std::optional<std::uint32_t> add_children(std::uint32_t entry);
    void set_child_mask(std::uint32_t entry, glm::uvec2 mask);

    /// Gives the tile a slot for its brick; none if all slots were given out in this round.
    /// @param may_stay  the brick counts as used in this round. If false, it counts as used just before the
    ///                  round of keep_since(), so that it takes the place of nothing that is needed now. Such
    ///                  a brick only replaces bricks that were not used for longer: two of them never take
    ///                  turns.
    [[nodiscard]] std::optional<int> add_brick(std::uint32_t entry, bool may_stay = true);
    /// Takes back the slot that add_brick() gave the tile: there is no room for its brick. The tile wants a
    /// brick again.
    void take_brick_back(std::uint32_t entry) { release_slot(*slot(entry)); }
    /// Evicts the brick that was not used for longest, if it may go for the brick of this slot, by the rules
    /// of add_brick(). @return false if no brick may go.
    [[nodiscard]] bool evict_brick_for(int slot);
    /// Called for each slot that becomes free.
    void tell_of_free_slots(std::function<void(int slot)> is_free) { is_free_ = std::move(is_free); }

    /// Records that the tile was produced. The entry keeps the record even if the brick is evicted.
    void set_produced(std::uint32_t entry) { add_flags(entry, NODE_PRODUCED); }
    [[nodiscard]] bool was_produced(std::uint32_t entry) const {
        return (entries_[entry].brick & NODE_PRODUCED) != 0;
    }
    /// Records that every voxel of the tile has this value (as ProducedTile::mean). Gives the tile's slot
    /// back; the tile will want no brick again.
    void set_constant(std::uint32_t entry, glm::u8vec4 mean);
    /// Records that finer levels add nothing to the tile: it will want no children. The tile must not have
    /// any.
    void set_final(std::uint32_t entry) { add_flags(entry, NODE_FINAL); }

    /// Sends the entries that changed to the GPU.
    void upload();
    void bind_for_reading() const;

    struct Counters {
        std::uint64_t bricks_evicted = 0;
        std::uint64_t nodes_evicted = 0;
        std::uint64_t bricks_relinked = 0;  ///< orphans that were linked to a new node of their tile
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }

    /// A brick that lost its slot. The slot holds its texels until the next brick is written there.
    struct EvictedBrick {
        Tile tile;
        int slot = 0;
    };
    /// Turns on, or off, the record that take_evicted() returns. Off at first.
    void record_evictions(bool record) { records_evictions_ = record; }
    /// Bricks that were evicted since the last call, oldest first.
    [[nodiscard]] std::vector<EvictedBrick> take_evicted() { return std::exchange(evicted_, {}); }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    [[nodiscard]] std::uint32_t block_of(std::uint32_t entry) const {
        return entry / std::uint32_t(shape_.child_count());
    }
    /// False if the entry's block was evicted, or given to another tile, since the rays asked.
    [[nodiscard]] bool still_there(std::uint32_t entry) const {
        const std::uint32_t block = block_of(entry);
        return block == 0 || (block_parent_[block] != none && block_birth_[block] != round_);
    }
    [[nodiscard]] std::uint32_t parent_entry(std::uint32_t entry) const {
        return block_parent_[block_of(entry)];
    }
    /// May a slot or a block with this stamp be evicted?
    [[nodiscard]] bool is_old(Round stamp) const {
        return stamp < round_ && (!keep_since_ || stamp < *keep_since_);
    }
    /// Takes a free slot; else evicts one that was last used before `limit`; -1 if there is neither.
    [[nodiscard]] int take_slot(Round limit);
    /// Evicts the brick that was not used for longest if that was before `limit`. False if there is none.
    [[nodiscard]] bool evict_old_brick(Round limit);
    /// Takes a free block; else evicts an old one; -1 if there is neither.
    [[nodiscard]] int take_block();
    [[nodiscard]] bool can_evict_block(int block) const;
    void evict_brick(int slot);
    void release_slot(int slot);
    void add_flags(std::uint32_t entry, std::uint32_t flags) {
        entries_[entry].brick |= flags;
        mark_dirty(entry);
    }
    void orphan_brick(std::uint32_t entry);
    void link_orphan(std::uint32_t entry);
    void gather_old_block(int block);
    void evict_block(int block);
    void pin_path(std::uint32_t entry);
    void mark_dirty(std::uint32_t entry) { dirty_.push_back(entry); }

    TreeShape shape_;
    Lru blocks_;
    Lru bricks_;
    Round round_;
    std::optional<Round> keep_since_;
    std::vector<interop::NodeEntry> entries_;
    std::vector<Tile> tiles_;                  // one per entry
    std::vector<std::uint32_t> block_parent_;  // entry whose children the block holds
    std::vector<int> block_child_blocks_;      // entries of the block that have children
    std::vector<Round> block_birth_;           // round that filled the block
    std::vector<std::uint32_t> slot_owner_;    // entry; `none` for a free slot and for an orphan's
    std::vector<Tile> slot_tile_;              // tile of the brick in the slot
    std::vector<Round> slot_birth_;            // round that gave the slot out
    std::unordered_map<Tile, OrphanBrick, TileHash> orphans_;
    std::vector<EvictedBrick> evicted_;
    bool records_evictions_ = false;
    std::function<void(int)> is_free_;
    std::vector<int> old_slots_;  // slots that may be evicted in this round, oldest last
    bool slots_sorted_ = false;
    /// Stamp and number of the blocks that may be evicted in this round: a heap, the oldest on top.
    std::vector<std::pair<Round, int>> old_blocks_;
    bool blocks_gathered_ = false;
    std::vector<std::uint32_t> dirty_;
    std::vector<std::uint32_t> means_;  // one per entry, RGBA8; empty if tiles have no means
    gl::Buffer node_buffer_;
    gl::TextureHandle node_texture_;
    gl::Buffer mean_buffer_;
    gl::TextureHandle mean_texture_;
    Counters counters_;
};

}  // namespace cairn::renderer
