#include "renderer/pool/tree.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <glad/gl.h>

#include "base/error.h"
#include "gl/buffer_texture.h"
#include "gl/limits.h"

namespace cairn::renderer {
namespace {

int block_count(const TreeShape& shape, std::size_t bytes, std::size_t entry_bytes) {
    const gl::Limits limits = gl::query_limits();
    const std::size_t block_bytes = std::size_t(shape.child_count()) * entry_bytes;
    const std::size_t most =
        std::min({bytes / block_bytes, limits.texture_buffer_texels / std::size_t(shape.child_count()),
                  std::size_t(1) << 24U});
    const std::size_t least = std::size_t(shape.max_level) + 2;
    if (most < least) {
        throw Error(Fault::usage, "node pool", fmt::format("{} bytes are too few", bytes),
                    fmt::format("give it at least {} bytes", least * block_bytes));
    }
    return int(most);
}

}  // namespace

Tree::Tree(const TreeShape& shape, int brick_slots, std::size_t node_pool_bytes, glm::uvec2 root_mask,
           bool has_means)
    : shape_(shape),
      blocks_(block_count(shape, node_pool_bytes,
                          sizeof(interop::NodeEntry) + (has_means ? sizeof(std::uint32_t) : 0))),
      bricks_(brick_slots) {
    const std::size_t entry_total = std::size_t(blocks_.count()) * std::size_t(shape.child_count());
    entries_.resize(entry_total, interop::NodeEntry{});
    tiles_.resize(entry_total);
    block_parent_.resize(std::size_t(blocks_.count()), none);
    block_child_blocks_.resize(std::size_t(blocks_.count()), 0);
    block_birth_.resize(std::size_t(blocks_.count()));
    slot_owner_.resize(std::size_t(brick_slots), none);
    slot_tile_.resize(std::size_t(brick_slots));
    slot_birth_.resize(std::size_t(brick_slots));
    node_buffer_ = gl::Buffer(entry_total * sizeof(interop::NodeEntry), "node pool");
    node_buffer_.fill(0);
    node_texture_ = gl::buffer_texture(GL_RGBA32UI, node_buffer_);
    if (has_means) {
        means_.resize(entry_total, 0);
        mean_buffer_ = gl::Buffer(entry_total * sizeof(std::uint32_t), "mean values of nodes");
        mean_buffer_.fill(0);
        mean_texture_ = gl::buffer_texture(GL_R32UI, mean_buffer_);
    }

    [[maybe_unused]] const int root_block = blocks_.take_free();  // the first one free is 0
    set_child_mask(0, root_mask);
    upload();
}

int Tree::bricks_used_since(Round round) const {
    int used = 0;
    for (int slot = 0; slot < bricks_.count(); ++slot)
        used += slot_owner_[std::size_t(slot)] != none && bricks_.stamp(slot) >= round ? 1 : 0;
    return used;
}

void Tree::begin_round(Round round, const std::vector<std::uint32_t>& brick_stamps) {
    round_ = round;
    slots_sorted_ = false;
    blocks_gathered_ = false;
    for (int slot = 0; slot < bricks_.count(); ++slot) {
        const std::uint32_t owner = slot_owner_[std::size_t(slot)];
        const Round stamp{brick_stamps[std::size_t(slot)]};
        if (owner == none || stamp <= bricks_.stamp(slot)) continue;
        bricks_.touch(slot, stamp);
        for (std::uint32_t entry = owner; entry != none; entry = parent_entry(entry)) {
            if (blocks_.stamp(int(block_of(entry))) >= stamp) break;
            blocks_.touch(int(block_of(entry)), stamp);
        }
    }
}

bool Tree::wants_children(std::uint32_t entry) const {
    const interop::NodeEntry& node = entries_[entry];
    return still_there(entry) && node.children == 0 && (node.brick & NODE_FINAL) == 0 &&
           tiles_[entry].level < shape_.max_level;
}

bool Tree::wants_brick(std::uint32_t entry) const {
    return still_there(entry) && (entries_[entry].brick & (NODE_SLOT | NODE_CONSTANT)) == 0;
}

void Tree::pin_path(std::uint32_t entry) {
    for (; entry != none; entry = parent_entry(entry))
        blocks_.touch(int(block_of(entry)), round_);
}

std::optional<std::uint32_t> Tree::add_children(std::uint32_t entry) {
    pin_path(entry);
    const int block = take_block();
    if (block < 0) return std::nullopt;
    blocks_.touch(block, round_);
    const std::uint32_t first = std::uint32_t(block) * std::uint32_t(shape_.child_count());
    block_parent_[std::size_t(block)] = entry;
    block_birth_[std::size_t(block)] = round_;
    if (entry != 0) ++block_child_blocks_[block_of(entry)];
    for (int child = 0; child < shape_.child_count(); ++child) {
        const std::uint32_t e = first + std::uint32_t(child);
        entries_[e] = interop::NodeEntry{};
        tiles_[e] = child_of(tiles_[entry], shape_.n, child);
        mark_dirty(e);
        link_orphan(e);
    }
    entries_[entry].children = first;
    mark_dirty(entry);
    return first;
}

void Tree::set_child_mask(std::uint32_t entry, glm::uvec2 mask) {
    entries_[entry].child_mask = mask;
    mark_dirty(entry);
}

std::optional<int> Tree::add_brick(std::uint32_t entry, bool may_stay) {
    pin_path(entry);
    const Round stamp = may_stay ? round_ : keep_since_ ? keep_since_->before() : Round{};
    const int slot = take_slot(stamp);
    if (slot < 0) return std::nullopt;
    bricks_.touch(slot, stamp);
    slot_owner_[std::size_t(slot)] = entry;
    slot_tile_[std::size_t(slot)] = tiles_[entry];
    slot_birth_[std::size_t(slot)] = round_;
    entries_[entry].brick |= std::uint32_t(slot) + 1;
    mark_dirty(entry);
    return slot;
}

int Tree::take_slot(Round limit) {
    if (const int slot = bricks_.take_free(); slot >= 0) return slot;
    return evict_old_brick(limit) ? bricks_.take_free() : -1;
}

bool Tree::evict_brick_for(int slot) {
    return evict_old_brick(bricks_.stamp(slot));
}

bool Tree::evict_old_brick(Round limit) {
    if (!slots_sorted_) {
        old_slots_.clear();
        for (int slot = 0; slot < bricks_.count(); ++slot) {
            // A slot that was given out in this round waits for its brick, however old its stamp.
            const bool is_new = slot_birth_[std::size_t(slot)] == round_;
            if (bricks_.is_taken(slot) && is_old(bricks_.stamp(slot)) && !is_new) old_slots_.push_back(slot);
        }
        std::sort(old_slots_.begin(), old_slots_.end(),
                  [&](int a, int b) { return bricks_.stamp(a) > bricks_.stamp(b); });
        slots_sorted_ = true;
    }
    while (!old_slots_.empty()) {
        const int slot = old_slots_.back();
        // It may have been released, and given out again, since the slots were sorted.
        const bool may_go =
            bricks_.is_taken(slot) && slot_birth_[std::size_t(slot)] != round_ && is_old(bricks_.stamp(slot));
        if (may_go && bricks_.stamp(slot) >= limit) return false;
        old_slots_.pop_back();
        if (!may_go) continue;
        evict_brick(slot);
        return true;
    }
    return false;
}

void Tree::evict_brick(int slot) {
    if (records_evictions_) evicted_.push_back({slot_tile_[std::size_t(slot)], slot});
    release_slot(slot);
    ++counters_.bricks_evicted;
}

void Tree::release_slot(int slot) {
    const std::uint32_t owner = slot_owner_[std::size_t(slot)];
    const Tile& tile = slot_tile_[std::size_t(slot)];
    if (owner == none) {
        orphans_.erase(tile);
    } else {
        entries_[owner].brick &= ~NODE_SLOT;
        mark_dirty(owner);
        slot_owner_[std::size_t(slot)] = none;
    }
    bricks_.release(slot);
    if (is_free_) is_free_(slot);
}

void Tree::set_constant(std::uint32_t entry, glm::u8vec4 mean) {
    if (const std::optional<int> held = slot(entry)) release_slot(*held);
    add_flags(entry, NODE_CONSTANT | (mean == glm::u8vec4(0) ? NODE_EMPTY : 0U));
    if (mean == glm::u8vec4(0)) return;
    if (means_.empty())
        throw Error(Fault::internal, "node pool", "a constant tile of content that was said to have none");
    means_[entry] = std::uint32_t(mean.x) | std::uint32_t(mean.y) << 8U | std::uint32_t(mean.z) << 16U |
                    std::uint32_t(mean.w) << 24U;
}

/// Keeps the brick of an evicted node in its slot, with the flags of the node.
void Tree::orphan_brick(std::uint32_t entry) {
    const std::optional<int> held = slot(entry);
    if (!held) return;
    slot_owner_[std::size_t(*held)] = none;
    orphans_.emplace(tiles_[entry], OrphanBrick{*held, entries_[entry].brick & ~NODE_SLOT});
}

/// Gives a new node the orphan of its tile, if there is one.
void Tree::link_orphan(std::uint32_t entry) {
    if (orphans_.empty()) return;
    const auto orphan = orphans_.find(tiles_[entry]);
    if (orphan == orphans_.end()) return;
    const auto [held, flags] = orphan->second;
    entries_[entry].brick = flags | (std::uint32_t(held) + 1);
    slot_owner_[std::size_t(held)] = entry;
    orphans_.erase(orphan);
    ++counters_.bricks_relinked;
}

bool Tree::can_evict_block(int block) const {
    return block != 0 && block_parent_[std::size_t(block)] != none &&
           block_child_blocks_[std::size_t(block)] == 0 && is_old(blocks_.stamp(block));
}

void Tree::gather_old_block(int block) {
    if (!can_evict_block(block)) return;
    old_blocks_.emplace_back(blocks_.stamp(block), block);
    std::push_heap(old_blocks_.begin(), old_blocks_.end(), std::greater<>());
}

int Tree::take_block() {
    if (const int block = blocks_.take_free(); block >= 0) return block;
    if (!blocks_gathered_) {
        old_blocks_.clear();
        for (int block = 0; block < blocks_.count(); ++block)
            gather_old_block(block);
        blocks_gathered_ = true;
    }
    while (!old_blocks_.empty()) {
        const int block = old_blocks_.front().second;
        std::pop_heap(old_blocks_.begin(), old_blocks_.end(), std::greater<>());
        old_blocks_.pop_back();
        if (!can_evict_block(block)) continue;
        evict_block(block);
        return blocks_.take_free();
    }
    return -1;
}

void Tree::evict_block(int block) {
    const std::uint32_t first = std::uint32_t(block) * std::uint32_t(shape_.child_count());
    for (std::uint32_t e = first; e < first + std::uint32_t(shape_.child_count()); ++e)
        orphan_brick(e);
    const std::uint32_t parent = block_parent_[std::size_t(block)];
    entries_[parent].children = 0;
    mark_dirty(parent);
    block_parent_[std::size_t(block)] = none;
    blocks_.release(block);
    ++counters_.nodes_evicted;
    if (parent == 0) return;
    --block_child_blocks_[block_of(parent)];
    gather_old_block(int(block_of(parent)));  // it may be the next to be evicted
}

void Tree::upload() {
    std::sort(dirty_.begin(), dirty_.end());
    dirty_.erase(std::unique(dirty_.begin(), dirty_.end()), dirty_.end());
    for (std::size_t i = 0; i < dirty_.size();) {
        std::size_t end = i + 1;
        while (end < dirty_.size() && dirty_[end] == dirty_[end - 1] + 1)
            ++end;
        node_buffer_.write(dirty_[i] * sizeof(interop::NodeEntry), &entries_[dirty_[i]],
                           (end - i) * sizeof(interop::NodeEntry));
        if (!means_.empty()) {
            mean_buffer_.write(dirty_[i] * sizeof(std::uint32_t), &means_[dirty_[i]],
                               (end - i) * sizeof(std::uint32_t));
        }
        i = end;
    }
    dirty_.clear();
}

void Tree::bind_for_reading() const {
    glBindTextureUnit(TEXTURE_NODES, node_texture_.id());
    if (!means_.empty()) glBindTextureUnit(TEXTURE_NODE_MEANS, mean_texture_.id());
}

}  // namespace cairn::renderer
