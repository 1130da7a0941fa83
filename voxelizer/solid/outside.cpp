#include "voxelizer/solid/outside.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include "voxelizer/solid/word_bits.h"

namespace cairn::voxelizer {
namespace {

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

Outside::Sides Outside::open_sides(const Region& whole) {
    Sides sides;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::ivec3 size(whole.size[axis == 0 ? 1 : 0], whole.size[axis == 2 ? 1 : 2], 1);
        sides[std::size_t(axis)] = {BitGrid(size), BitGrid(size)};
    }
    return sides;
}

Outside::Outside(const Region& whole, std::size_t memory_bytes)
    : whole_(whole), counts_((whole.size - 1) / block_side + 1), memory_bytes_(memory_bytes) {
    const std::size_t count = std::size_t(counts_.x) * std::size_t(counts_.y) * std::size_t(counts_.z);
    blocks_.resize(count);
    wholly_reached_.assign(count, 0);
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
    return least_bytes(whole_) + stored_ * sizeof(Block);
}

std::size_t Outside::least_bytes(const Region& whole) {
    const glm::u64vec3 size(whole.size);
    const glm::u64vec3 counts = (size - std::uint64_t(1)) / std::uint64_t(block_side) + std::uint64_t(1);
    const std::uint64_t places = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
    return counts.x * counts.y * counts.z * (sizeof(std::unique_ptr<Block>) + sizeof(std::uint8_t)) +
           places / 8;
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
            const BitGrid& side = closed_[std::size_t(axis)][high ? 1 : 0];
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

void Outside::flood(Sides closed) {
    closed_ = std::move(closed);
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

Outside::Word Outside::word_at(const glm::ivec3& voxel) const {
    const glm::ivec3 at = voxel - whole_.origin;
    const glm::ivec3 within = at % block_side;
    const std::size_t number = number_of(at / block_side);
    const std::uint32_t in_region = low_bits(whole_.size.x - at.x);
    const std::uint32_t free =
        blocks_[number] ? blocks_[number]->free[std::size_t(within.z) * block_side + std::size_t(within.y)]
                        : in_region;
    const std::uint32_t reached = row_reached(number, within.y, within.z) & in_region;
    return {reached, free & ~reached, in_region & ~free};
}

template <typename Part>
BitGrid Outside::copied(const glm::ivec3& tile_origin, const glm::ivec3& tile_size, const Part& part) const {
    BitGrid tile(tile_size);
    tbb::parallel_for(0, tile_size.z, [&](int z) {
        for (int y = 0; y < tile_size.y; ++y) {
            for (int x = 0; x < tile_size.x; x += block_side) {
                tile.words[tile.word_index(x, y, z)] =
                    low_bits(tile_size.x - x) & part(word_at(tile_origin + glm::ivec3(x, y, z)));
            }
        }
    });
    return tile;
}

BitGrid Outside::solid(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    return copied(tile_origin, tile_size, [](const Word& word) { return word.enclosed | word.surface; });
}

BitGrid Outside::surface(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    return copied(tile_origin, tile_size, [](const Word& word) { return word.surface; });
}

bool Outside::holds(const glm::ivec3& voxel) const {
    const glm::ivec3 at = voxel - whole_.origin;
    return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, whole_.size));
}

bool Outside::touches(const glm::ivec3& voxel) const {
    const glm::ivec3 at = voxel - whole_.origin;
    const std::unique_ptr<Block>& block = blocks_[number_of(at / block_side)];
    const glm::ivec3 within = at % block_side;
    return block &&
           (block->free[std::size_t(within.z) * block_side + std::size_t(within.y)] >> within.x & 1U) == 0;
}

bool Outside::has_surface(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const {
    const glm::ivec3 first = (tile_origin - whole_.origin) / block_side;
    const glm::ivec3 last = (tile_origin - whole_.origin + tile_size - 1) / block_side;
    for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                if (blocks_[number_of({x, y, z})]) return true;
            }
        }
    }
    return false;
}

}  // namespace cairn::voxelizer
