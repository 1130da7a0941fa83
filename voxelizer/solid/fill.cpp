#include "voxelizer/solid/fill.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>
#include <tuple>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "voxelizer/solid/solid_triangles.h"

namespace cairn::voxelizer {
namespace {

using Row = std::span<const RowCrossings::Event>;

bool is_whole(Row row) {
    int winding = 0;
    for (const RowCrossings::Event& event : row)
        winding += event.winding();
    return winding == 0;
}

/// Calls visit(first, end, whole) for each stretch of a row that it says is inside: by winding if the row is
/// whole, else by parity.
template <typename Visit>
void visit_inside(Row row, const Visit& visit) {
    const bool whole = is_whole(row);
    int depth = 0;
    int since = 0;
    for (const RowCrossings::Event& event : row) {
        const int before = depth;
        depth = whole ? depth + event.winding() : 1 - depth;
        if (before == 0) since = event.voxel();
        if (depth == 0 && since < event.voxel()) visit(since, event.voxel(), whole);
    }
}

/// The vote of a row on one of its voxels.
struct Verdict {
    bool inside = false;
    bool whole = false;
};
Verdict verdict_on(Row row, int voxel) {
    Verdict verdict;
    visit_inside(row, [&](int first, int end, bool whole) {
        if (first <= voxel && voxel < end) verdict = {true, whole};
    });
    return verdict;
}

/// Bits from first up to, not including, end.
void set_bits(std::uint32_t* words, int first, int end) {
    while (first < end) {
        const int stop = std::min(end, (first / 32 + 1) * 32);
        const std::uint32_t up_to = stop % 32 == 0 ? ~0U : (1U << (stop % 32)) - 1U;
        words[first / 32] |= up_to & (~0U << (first % 32));
        first = stop;
    }
}

/// A mixing of 64 bits (the finalizer of SplitMix64: Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ x >> 30U) * 0xBF58476D1CE4E5B9U;
    x = (x ^ x >> 27U) * 0x94D049BB133111EBU;
    return x ^ x >> 31U;
}
std::uint64_t hash_of(const glm::i64vec3& p, const glm::i64vec3& q, std::uint64_t seed) {
    for (const glm::i64vec3& point : {p, q}) {
        for (int axis = 0; axis < 3; ++axis)
            seed = mixed(seed + 0x9E3779B97F4A7C15U + std::uint64_t(point[axis]));
    }
    return seed;
}

/// Whether each edge is used as often in one direction as in the other: the hashes of edges add up to 0, each
/// with the sign of its direction.
bool is_closed(const Surface& surface) {
    std::atomic<std::uint64_t> first{0};
    std::atomic<std::uint64_t> second{0};
    for_each_triangle(surface, [&](const std::array<glm::i64vec3, 3>& corners) {
        std::uint64_t a = 0;
        std::uint64_t b = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::i64vec3& p = corners[i];
            const glm::i64vec3& q = corners[(i + 1) % 3];
            if (p == q) continue;
            const bool forward = std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
            const std::uint64_t one = forward ? hash_of(p, q, 1) : 0 - hash_of(q, p, 1);
            const std::uint64_t other = forward ? hash_of(p, q, 2) : 0 - hash_of(q, p, 2);
            a += one;
            b += other;
        }
        first.fetch_add(a, std::memory_order_relaxed);
        second.fetch_add(b, std::memory_order_relaxed);
    });
    return first == 0 && second == 0;
}

/// Rows of a region along an axis that are not whole.
std::uint64_t count_doubtful(const RowCrossings& rows, const glm::ivec3& size, int axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::atomic<std::uint64_t> count{0};
    tbb::parallel_for(0, size[v], [&](int at_v) {
        std::uint64_t here = 0;
        glm::ivec3 voxel(0);
        voxel[v] = at_v;
        for (voxel[u] = 0; voxel[u] < size[u]; ++voxel[u])
            here += rows.is_odd(voxel) || !is_whole(rows.row(voxel)) ? 1 : 0;
        count += here;
    });
    return count;
}

}  // namespace

SolidFill::SolidFill(const Surface& surface, const Region& whole, std::size_t memory_bytes)
    : whole_(whole), along_x_(surface, whole, 0, memory_bytes) {
    if (is_closed(surface)) return;
    std::size_t left = memory_bytes - along_x_.size_bytes();
    along_y_.emplace(surface, whole, 1, left);
    left -= along_y_->size_bytes();
    along_z_.emplace(surface, whole, 2, left);
    doubtful_rows_ = count_doubtful(along_x_, whole.size, 0) + count_doubtful(*along_y_, whole.size, 1) +
                     count_doubtful(*along_z_, whole.size, 2);
}

std::uint64_t SolidFill::row_count() const {
    const glm::u64vec3 size(whole_.size);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

std::size_t SolidFill::size_bytes() const {
    return along_x_.size_bytes() + (along_y_ ? along_y_->size_bytes() : 0) +
           (along_z_ ? along_z_->size_bytes() : 0);
}

void SolidFill::add_interior(const glm::ivec3& tile_origin, BitGrid& tile) const {
    const glm::ivec3 low = tile_origin - whole_.origin;
    if (glm::any(glm::lessThan(low, glm::ivec3(0))) ||
        glm::any(glm::greaterThan(low + tile.size, whole_.size))) {
        throw Error(Fault::usage, "solid fill",
                    fmt::format("the tile at ({}, {}, {}) reaches outside the region", tile_origin.x,
                                tile_origin.y, tile_origin.z));
    }
    tbb::parallel_for(0, tile.size.z, [&](int z) {
        if (closed()) {
            fill_slice(low, z, tile);
        } else {
            vote_on_slice(low, z, tile);
        }
    });
}

void SolidFill::fill_slice(const glm::ivec3& low, int z, BitGrid& tile) const {
    for (int y = 0; y < tile.size.y; ++y) {
        std::uint32_t* const words = &tile.words[tile.word_index(0, y, z)];
        visit_inside(along_x_.row(low + glm::ivec3(0, y, z)), [&](int first, int end, bool /*whole*/) {
            set_bits(words, std::max(first - low.x, 0), std::min(end - low.x, tile.size.x));
        });
    }
}

void SolidFill::vote_on_slice(const glm::ivec3& low, int z, BitGrid& tile) const {
    // The votes of the rows along one axis on the slice: of all rows, and of those that are not doubtful.
    struct Votes {
        BitGrid inside, by_whole;
    };
    const glm::ivec3 slice(tile.size.x, tile.size.y, 1);
    Votes by_x{BitGrid(slice), BitGrid(slice)};
    Votes by_y = by_x;
    for (int y = 0; y < tile.size.y; ++y) {
        const std::size_t word = by_x.inside.word_index(0, y, 0);
        visit_inside(along_x_.row(low + glm::ivec3(0, y, z)), [&](int first, int end, bool whole) {
            const int from = std::max(first - low.x, 0);
            const int to = std::min(end - low.x, tile.size.x);
            set_bits(&by_x.inside.words[word], from, to);
            if (whole) set_bits(&by_x.by_whole.words[word], from, to);
        });
    }
    for (int x = 0; x < tile.size.x; ++x) {
        visit_inside(along_y_->row(low + glm::ivec3(x, 0, z)), [&](int first, int end, bool whole) {
            for (int y = std::max(first - low.y, 0); y < std::min(end - low.y, tile.size.y); ++y) {
                by_y.inside.set({x, y, 0});
                if (whole) by_y.by_whole.set({x, y, 0});
            }
        });
    }
    for (std::size_t word = 0; word < by_x.inside.words.size(); ++word) {
        const std::uint32_t two = by_x.by_whole.words[word] & by_y.by_whole.words[word];
        const std::uint32_t one = by_x.by_whole.words[word] | by_y.by_whole.words[word];
        const std::uint32_t both = by_x.inside.words[word] & by_y.inside.words[word];
        std::uint32_t found = two;
        // Rows along z are asked where they decide.
        for (std::uint32_t left = (one | both) & ~two; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left);
            const auto row = int(word) / by_x.inside.words_per_row();
            const glm::ivec3 voxel =
                low + glm::ivec3(int(word) % by_x.inside.words_per_row() * 32 + bit, row, z);
            const Verdict by_z = verdict_on(along_z_->row(voxel), voxel.z);
            const bool second = by_z.whole && (one >> bit & 1U) != 0;
            if (by_z.inside && (second || (both >> bit & 1U) != 0)) found |= 1U << bit;
        }
        tile.words[tile.word_index(0, 0, z) + word] |= found;
    }
}

}  // namespace cairn::voxelizer
