#include "voxelizer/solid/outside.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include "voxelizer/solid/visit_crossings.h"

namespace cairn::voxelizer {
namespace {

/// The lowest bits of a word.
std::uint32_t low_bits(int count) {
    return count >= 32 ? ~0U : (1U << count) - 1U;
}

/// Spreads bits along a word, within those that are free (Kogge and Stone 1973: steps of doubled length).
std::uint32_t spread(std::uint32_t bits, std::uint32_t free) {
    std::uint32_t up = free;
    std::uint32_t down = free;
    for (int step = 1; step < 32; step *= 2) {
        bits |= (up & (bits << step)) | (down & (bits >> step));
        up &= up << step;
        down &= down >> step;
    }
    return bits;
}

/// Spreads what is reached over all that is free, rows along x of a cube of 32^3 voxels.
template <typename Rows>
void spread_in_block(Rows& reached, const Rows& free) {
    constexpr int side = Outside::block_side;
    const auto update = [&](int y, int z, int step) {
        const std::size_t i = std::size_t(z) * side + std::size_t(y);
        std::uint32_t bits = reached[i];
        const int y_before = y - step;
        const int z_before = z - step;
        if (y_before >= 0 && y_before < side) bits |= reached[std::size_t(z) * side + std::size_t(y_before)];
        if (z_before >= 0 && z_before < side) bits |= reached[std::size_t(z_before) * side + std::size_t(y)];
        bits = spread(bits & free[i], free[i]);
        return std::exchange(reached[i], bits) != bits;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (int z = 0; z < side; ++z) {
            for (int y = 0; y < side; ++y)
                changed = update(y, z, 1) || changed;
        }
        for (int z = side - 1; z >= 0; --z) {
            for (int y = side - 1; y >= 0; --y)
                changed = update(y, z, -1) || changed;
        }
    }
}

}  // namespace

Outside::Outside(const Surface& surface, const Region& whole, std::size_t memory_bytes)
    : whole_(whole), counts_((whole.size - 1) / block_side + 1), memory_bytes_(memory_bytes) {
    const std::size_t count = std::size_t(counts_.x) * std::size_t(counts_.y) * std::size_t(counts_.z);
    blocks_.resize(count);
    wholly_reached_.assign(count, 0);
    for (int axis = 0; axis < 3; ++axis)
        find_covered(surface, axis);
}

std::size_t Outside::number_of(const glm::ivec3& place) const {
    return (std::size_t(place.z) * std::size_t(counts_.y) + std::size_t(place.y)) * std::size_t(counts_.x) +
           std::size_t(place.x);
}

glm::ivec3 Outside::place_of(std::size_t number) const {
    const std::size_t x = std::size_t(counts_.x);
    const std::size_t y = std::size_t(counts_.y);
    return {number % x, number / x % y, number / x / y};
}

glm::ivec3 Outside::size_of(const glm::ivec3& place) const {
    return glm::min(whole_.size - place * block_side, glm::ivec3(block_side));
}

std::size_t Outside::size_bytes() const {
    return blocks_.size() * (sizeof(blocks_[0]) + sizeof(wholly_reached_[0])) + stored_ * sizeof(Block);
}

std::unique_ptr<Outside::Block> Outside::make_block(const glm::ivec3& place) const {
    auto block = std::make_unique<Block>();
    const glm::ivec3 size = size_of(place);
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y)
            block->free[std::size_t(z) * block_side + std::size_t(y)] = low_bits(size.x);
    }
    return block;
}

void Outside::find_covered(const Surface& surface, int axis) {
    const int across = axis == 0 ? 1 : 0;
    const int down = axis == 2 ? 1 : 2;
    auto& sides = covered_[std::size_t(axis)];
    for (BitGrid& side : sides)
        side = BitGrid({whole_.size[across], whole_.size[down], 1});
    const int length = whole_.size[axis];
    const std::int64_t voxel = whole_.voxel_side();
    const std::int64_t first_centre = std::int64_t(whole_.origin[axis]) * voxel + voxel / 2;
    const std::int64_t last_centre = first_centre + std::int64_t(length - 1) * voxel;
    const auto may_lie_beyond = [&](const LatticeCorners& corners) {
        return std::ranges::any_of(corners, [&](const glm::i64vec3& corner) {
            return corner[axis] <= first_centre || corner[axis] >= last_centre;
        });
    };
    visit_crossings(surface, whole_, axis, may_lie_beyond, [&](int u, int v, const auto& rows) {
        const std::int64_t beyond = rows.first_beyond(u, v);
        if (beyond > 0 && beyond < length) return;
        glm::ivec3 at(0);
        at[(axis + 1) % 3] = u;
        at[(axis + 2) % 3] = v;
        BitGrid& side = sides[beyond > 0 ? 1 : 0];
        std::atomic_ref(side.words[side.word_index(at[across], at[down], 0)])
            .fetch_or(1U << (at[across] % 32), std::memory_order_relaxed);
    });
}

bool Outside::add_surface(const glm::ivec3& tile_origin, const BitGrid& tile) {
    const glm::ivec3 low = tile_origin - whole_.origin;
    for (int z = 0; z < tile.size.z; ++z) {
        for (int y = 0; y < tile.size.y; ++y) {
            for (int x = 0; x < tile.size.x; x += block_side) {
                const std::uint32_t touched = tile.words[tile.word_index(x, y, z)];
                if (touched == 0) continue;
                const glm::ivec3 voxel = low + glm::ivec3(x, y, z);
                std::unique_ptr<Block>& block = blocks_[number_of(voxel / block_side)];
                if (!block) {
                    if (size_bytes() + sizeof(Block) > memory_bytes_) return false;
                    block = make_block(voxel / block_side);
                    ++stored_;
                }
                const glm::ivec3 within = voxel % block_side;
                block->free[std::size_t(within.z) * block_side + std::size_t(within.y)] &= ~touched;
            }
        }
    }
    return true;
}

std::uint32_t Outside::row_reached(std::size_t number, int y, int z) const {
    if (!blocks_[number]) return wholly_reached_[number] != 0 ? ~0U : 0U;
    return blocks_[number]->reached[std::size_t(z) * block_side + std::size_t(y)];
}

template <typename Visit>
void Outside::visit_entries(std::size_t number, const Visit& visit) const {
    const glm::ivec3 place = place_of(number);
    const glm::ivec3 size = size_of(place);
    const glm::ivec3 low = place * block_side;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            glm::ivec3 beside = place;
            beside[axis] += high ? 1 : -1;
            const bool within = beside[axis] >= 0 && beside[axis] < counts_[axis];
            const std::size_t neighbour = within ? number_of(beside) : 0;
            const BitGrid& side = covered_[std::size_t(axis)][high ? 1 : 0];
            const int last = block_side - 1;
            const int here = high ? size[axis] - 1 : 0;  // the layer of this block, and the neighbour's
            const int there = high ? 0 : last;
            if (axis == 0) {
                for (int z = 0; z < size.z; ++z) {
                    for (int y = 0; y < size.y; ++y) {
                        const bool enters = within ? (row_reached(neighbour, y, z) >> there & 1U) != 0
                                                   : !side.at({low.y + y, low.z + z, 0});
                        if (enters) visit(y, z, 1U << here);
                    }
                }
                continue;
            }
            for (int across = 0; across < (axis == 1 ? size.z : size.y); ++across) {
                std::uint32_t word = low_bits(size.x);
                if (!within) {
                    word &= ~side.words[side.word_index(low.x, low[3 - axis] + across, 0)];
                } else if (axis == 1) {
                    word &= row_reached(neighbour, there, across);
                } else {
                    word &= row_reached(neighbour, across, there);
                }
                if (axis == 1) {
                    visit(here, across, word);
                } else {
                    visit(across, here, word);
                }
            }
        }
    }
}

template <typename Visit>
void Outside::visit_neighbours(std::size_t number, const Visit& visit) const {
    const glm::ivec3 place = place_of(number);
    for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
            glm::ivec3 beside = place;
            beside[axis] += step;
            if (beside[axis] >= 0 && beside[axis] < counts_[axis]) visit(number_of(beside));
        }
    }
}

bool Outside::is_beside_wholly_reached(std::size_t number) const {
    bool found = false;
    visit_neighbours(number, [&](std::size_t beside) {
        found = found || (!blocks_[beside] && wholly_reached_[beside] != 0);
    });
    return found;
}

bool Outside::advance(std::size_t number) {
    if (!blocks_[number]) {
        if (wholly_reached_[number] != 0) return false;
        bool reached = is_beside_wholly_reached(number);
        if (!reached) {
            visit_entries(number,
                          [&](int /*y*/, int /*z*/, std::uint32_t word) { reached = reached || word != 0; });
        }
        wholly_reached_[number] = reached ? 1 : 0;
        return reached;
    }
    Block& block = *blocks_[number];
    bool entered = false;
    visit_entries(number, [&](int y, int z, std::uint32_t word) {
        const std::size_t row = std::size_t(z) * block_side + std::size_t(y);
        const std::uint32_t more = word & block.free[row] & ~block.reached[row];
        block.reached[row] |= more;
        entered = entered || more != 0;
    });
    if (entered) spread_in_block(block.reached, block.free);
    return entered;
}

void Outside::flood() {
    // Blocks whose places have an even sum advance together, and then the others: neighbours by a face are
    // never both written and read.
    std::array<tbb::concurrent_vector<std::size_t>, 2> waiting;
    std::vector<std::uint8_t> waits(blocks_.size(), 0);
    const auto ask = [&](std::size_t number) {
        if (std::atomic_ref(waits[number]).exchange(1, std::memory_order_relaxed) != 0) return;
        const glm::ivec3 place = place_of(number);
        waiting[std::size_t(place.x + place.y + place.z) % 2].push_back(number);
    };
    for (std::size_t number = 0; number < blocks_.size(); ++number) {
        const glm::ivec3 place = place_of(number);
        if (glm::any(glm::equal(place, glm::ivec3(0))) || glm::any(glm::equal(place, counts_ - 1)))
            ask(number);
    }
    for (std::size_t turn = 0; !waiting[0].empty() || !waiting[1].empty(); turn = 1 - turn) {
        const tbb::concurrent_vector<std::size_t> now = std::exchange(waiting[turn], {});
        tbb::parallel_for(std::size_t(0), now.size(), [&](std::size_t i) {
            waits[now[i]] = 0;
            if (advance(now[i])) visit_neighbours(now[i], ask);
        });
    }
}

template <typename Row>
BitGrid Outside::copied(const glm::ivec3& tile_origin, const glm::ivec3& tile_size, const Row& row) const {
    const glm::ivec3 low = tile_origin - whole_.origin;
    BitGrid tile(tile_size);
    tbb::parallel_for(0, tile_size.z, [&](int z) {
        for (int y = 0; y < tile_size.y; ++y) {
            for (int x = 0; x < tile_size.x; x += block_side) {
                const glm::ivec3 voxel = low + glm::ivec3(x, y, z);
                const glm::ivec3 within = voxel % block_side;
                tile.words[tile.word_index(x, y, z)] =
                    low_bits(tile_size.x - x) & row(number_of(voxel / block_side), within.y, within.z);
            }
        }
    });
    return tile;
}

BitGrid Outside::reached(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    return copied(tile_origin, tile_size,
                  [this](std::size_t number, int y, int z) { return row_reached(number, y, z); });
}

BitGrid Outside::enclosed(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    return copied(tile_origin, tile_size, [this](std::size_t number, int y, int z) {
        const std::uint32_t free =
            blocks_[number] ? blocks_[number]->free[std::size_t(z) * block_side + std::size_t(y)] : ~0U;
        return free & ~row_reached(number, y, z);
    });
}

BitGrid Outside::solid(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    return copied(tile_origin, tile_size,
                  [this](std::size_t number, int y, int z) { return ~row_reached(number, y, z); });
}

}  // namespace cairn::voxelizer
