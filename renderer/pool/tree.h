#pragma once

#include <cstddef>
#include <cstdint>
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

/// The N^3-tree: the node pool on the GPU, its mirror on the CPU, and who owns which slot of the brick pool
/// (Crassin et al. 2008, sections 4.2 and 4.3).
///
/// The node pool is an array of NodeEntry in blocks of n^3: the children of one tile. Block 0 holds the root
/// alone, in its entry 0. Both stores are bounded and recycle what was not used for longest; a parent
/// outlives its children. The bricks of nodes that go stay in their slots, as orphans, for as long as their
/// own stamps let them: when their tiles come back, they are linked again.
class Tree {
public:
    /// @param root_mask    child_mask of the root tile.
    /// @param has_means    tiles may be constant without being empty: then what they hold is kept beside the
    /// entries.
    /// @throws Error (Fault::usage) when `node_pool_bytes` holds fewer blocks than one path from root to
    /// leaf.
    Tree(const TreeShape& shape, int brick_slots, std::size_t node_pool_bytes, glm::uvec2 root_mask,
         bool has_means = false);

    [[nodiscard]] const TreeShape& shape() const { return shape_; }
    [[nodiscard]] const Tile& tile(std::uint32_t entry) const { return tiles_[entry]; }
    /// The mirror of an entry, as the next upload() leaves it on the GPU.
    [[nodiscard]] const interop::NodeEntry& node(std::uint32_t entry) const { return entries_[entry]; }
    [[nodiscard]] std::uint32_t entry_count() const { return std::uint32_t(entries_.size()); }
    /// Slot of its brick in the pool; none where it holds none.
    [[nodiscard]] std::optional<int> slot(std::uint32_t entry) const {
        const std::uint32_t number = entries_[entry].brick & NODE_SLOT;
        return number != 0 ? std::optional(int(number) - 1) : std::nullopt;
    }
    [[nodiscard]] std::size_t size_bytes() const {
        return node_buffer_.size_bytes() + mean_buffer_.size_bytes();
    }
    [[nodiscard]] int bricks_resident() const { return bricks_.used_count(); }  ///< orphans included
    /// Bricks that nodes hold and that were given out, or used by rays, in that round or later.
    [[nodiscard]] int bricks_used_since(Round round) const;

    /// A brick whose node is gone.
    struct Orphan {
        int slot = 0;
        std::uint32_t flags = 0;  ///< NODE_*, of the node
    };
    [[nodiscard]] const std::unordered_map<Tile, Orphan, TileHash>& orphans() const { return orphans_; }

    /// Starts a round; stamps what rays used in the pass before it, and their ancestors.
    /// @param brick_stamps  one a slot: the last round whose rays used it.
    void begin_round(Round round, const std::vector<std::uint32_t>& brick_stamps);

    /// What rays used in that round or later is not evicted until this is called again. Without a round,
    /// whatever the current one did not use may go.
    void keep_since(std::optional<Round> round) { keep_since_ = round; }

    /// Still a question? An earlier answer of the round, or an eviction, may have settled it.
    [[nodiscard]] bool wants_children(std::uint32_t entry) const;
    [[nodiscard]] bool wants_brick(std::uint32_t entry) const;

    /// Makes room for the children of a tile. @return the first entry, to be filled with set_child_mask for
    /// each child
    ///         that is not empty; none when every block is in use in this round (the ray asks again in the
    ///         next).
    [[nodiscard]] std::optional<std::uint32_t> add_children(std::uint32_t entry);
    void set_child_mask(std::uint32_t entry, glm::uvec2 mask);

    /// Gives the tile a slot for its brick, or none when all slots were given out in this round.
    /// @param may_stay  counts as used in this round; else as used just before keep_since(), so that it takes
    ///                  the place of nothing that is needed now. Such a brick only takes the place of what
    ///                  was not used for longer: two of them never take turns.
    [[nodiscard]] std::optional<int> add_brick(std::uint32_t entry, bool may_stay = true);

    /// What a tile turned out to hold when it was produced. It stays known as long as the tile has its entry,
    /// though the brick may go.
    void set_produced(std::uint32_t entry) { add_flags(entry, NODE_PRODUCED); }
    [[nodiscard]] bool was_produced(std::uint32_t entry) const {
        return (entries_[entry].brick & NODE_PRODUCED) != 0;
    }
    /// Every voxel has this value, as in Produced::mean: gives its slot back, and none will be wanted again.
    void set_constant(std::uint32_t entry, glm::u8vec4 mean);
    /// Nothing finer adds to it: it will want no children. Not to be said of a tile that has any.
    void set_final(std::uint32_t entry) { add_flags(entry, NODE_FINAL); }

    /// Sends what changed to the GPU.
    void upload();
    void bind_for_reading() const;

    struct Counters {
        std::uint64_t bricks_evicted = 0;
        std::uint64_t nodes_evicted = 0;
        std::uint64_t bricks_relinked = 0;  ///< that came back with their node, without being produced
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }

    /// A brick that lost its slot, whose texels are there until the slot's next brick is written.
    struct Evicted {
        Tile tile;
        int slot = 0;
    };
    /// From now on, remember what was evicted. Off at first.
    void record_evictions(bool record) { records_evictions_ = record; }
    /// What was evicted since the last call, oldest first.
    [[nodiscard]] std::vector<Evicted> take_evicted() { return std::exchange(evicted_, {}); }

private:
    static constexpr std::uint32_t none = 0xFFFFFFFFU;

    [[nodiscard]] std::uint32_t block_of(std::uint32_t entry) const {
        return entry / std::uint32_t(shape_.child_count());
    }
    /// False when the entry's block was taken away, or given to another tile, since the rays asked.
    [[nodiscard]] bool still_there(std::uint32_t entry) const {
        const std::uint32_t block = block_of(entry);
        return block == 0 || (block_parent_[block] != none && block_birth_[block] != round_);
    }
    [[nodiscard]] std::uint32_t parent_entry(std::uint32_t entry) const {
        return block_parent_[block_of(entry)];
    }
    /// May what was last used then be evicted?
    [[nodiscard]] bool is_old(Round stamp) const {
        return stamp < round_ && (!keep_since_ || stamp < *keep_since_);
    }
    /// One that was last used before `limit`, if none is free; -1: there is none.
    [[nodiscard]] int take_slot(Round limit);
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
    std::vector<Tile> tiles_;                  // of each entry
    std::vector<std::uint32_t> block_parent_;  // entry whose children the block holds
    std::vector<int> block_child_blocks_;      // how many of its entries have children
    std::vector<Round> block_birth_;           // the round that filled it
    std::vector<std::uint32_t> slot_owner_;    // entry, or none: free, or an orphan's
    std::vector<Tile> slot_tile_;              // of those that are not free
    std::vector<Round> slot_birth_;            // the round that gave it out
    std::unordered_map<Tile, Orphan, TileHash> orphans_;
    std::vector<Evicted> evicted_;
    bool records_evictions_ = false;
    std::vector<int> old_slots_;  // of this round, oldest last
    bool slots_sorted_ = false;
    /// Stamp and number of the blocks that may be taken away in this round: a heap, the oldest on top.
    std::vector<std::pair<Round, int>> old_blocks_;
    bool blocks_gathered_ = false;
    std::vector<std::uint32_t> dirty_;
    std::vector<std::uint32_t> means_;  // of each entry, RGBA8; empty without them
    gl::Buffer node_buffer_;
    gl::TextureHandle node_texture_;
    gl::Buffer mean_buffer_;
    gl::TextureHandle mean_texture_;
    Counters counters_;
};

}  // namespace cairn::renderer
