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
#include "voxelizer/solid/word_bits.h"

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
/// whole, else by parity. To SolidRule::parity every row is whole: the odd ones have no crossings.
template <typename Visit>
void visit_inside(Row row, SolidRule rule, const Visit& visit) {
    const bool by_winding = rule == SolidRule::winding && is_whole(row);
    const bool whole = rule == SolidRule::parity || by_winding;
    int depth = 0;
    int since = 0;
    for (const RowCrossings::Event& event : row) {
        const int before = depth;
        depth = by_winding ? depth + event.winding() : 1 - depth;
        if (before == 0) since = event.voxel();
        if (depth == 0 && since < event.voxel()) visit(since, event.voxel(), whole);
    }
}

/// The vote of a row on one of its voxels.
struct Verdict {
    bool inside = false;
    bool whole = false;
};
Verdict verdict_on(Row row, SolidRule rule, int voxel) {
    Verdict verdict;
    visit_inside(row, rule, [&](int first, int end, bool whole) {
        if (first <= voxel && voxel < end) verdict = {true, whole};
    });
    return verdict;
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

/// Sums over the edges of a surface, in any order: 0 if each edge is used as often as the rule wants.
class EdgeSums {
public:
    explicit EdgeSums(SolidRule rule) : rule_(rule) {}

    void add(const std::array<glm::i64vec3, 3>& corners) {
        std::array<std::uint64_t, 2> here{};
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::i64vec3& p = corners[i];
            const glm::i64vec3& q = corners[(i + 1) % 3];
            if (p == q) continue;
            const bool forward = std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
            for (std::size_t k = 0; k < 2; ++k) {
                const std::uint64_t hash = forward ? hash_of(p, q, k + 1) : hash_of(q, p, k + 1);
                if (rule_ == SolidRule::parity) {
                    here[k] ^= hash;
                } else {
                    here[k] += forward ? hash : 0 - hash;
                }
            }
        }
        for (std::size_t k = 0; k < 2; ++k) {
            if (rule_ == SolidRule::parity) {
                sums_[k].fetch_xor(here[k], std::memory_order_relaxed);
            } else {
                sums_[k].fetch_add(here[k], std::memory_order_relaxed);
            }
        }
    }
    [[nodiscard]] bool are_zero() const { return sums_[0] == 0 && sums_[1] == 0; }

private:
    SolidRule rule_;
    std::array<std::atomic<std::uint64_t>, 2> sums_{};
};

/// Whether each edge is used as often in one direction as in the other: the hashes of edges add up to 0, each
/// with the sign of its direction. By parity, whether each is used an even number of times: the hashes cancel
/// each other bit by bit.
bool is_closed(const Surface& surface, SolidRule rule) {
    EdgeSums sums(rule);
    for_each_triangle(surface, [&](const std::array<glm::i64vec3, 3>& corners) { sums.add(corners); });
    return sums.are_zero();
}

bool is_doubtful(const RowCrossings& rows, const glm::ivec3& voxel, SolidRule rule) {
    return rows.is_odd(voxel) || (rule == SolidRule::winding && !is_whole(rows.row(voxel)));
}

/// Doubtful rows of a region along an axis.
std::uint64_t count_doubtful(const RowCrossings& rows, const glm::ivec3& size, int axis, SolidRule rule) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::atomic<std::uint64_t> count{0};
    tbb::parallel_for(0, size[v], [&](int at_v) {
        std::uint64_t here = 0;
        glm::ivec3 voxel(0);
        voxel[v] = at_v;
        for (voxel[u] = 0; voxel[u] < size[u]; ++voxel[u])
            here += is_doubtful(rows, voxel, rule) ? 1 : 0;
        count += here;
    });
    return count;
}

}  // namespace

SolidFill::SolidFill(const Surface& surface, const Region& whole, const SolidOptions& options)
    : whole_(whole), rule_(options.rule), along_x_(surface, whole, 0, options.memory_bytes) {
    if (rule_ == SolidRule::outside)
        throw Error(Fault::usage, "solid fill", "what the outside reaches is not found by crossings");
    if (is_closed(surface, rule_)) return;
    std::size_t left = options.memory_bytes - along_x_.size_bytes();
    along_y_.emplace(surface, whole, 1, left);
    left -= along_y_->size_bytes();
    along_z_.emplace(surface, whole, 2, left);
    doubtful_rows_ = count_doubtful(along_x_, whole.size, 0, rule_) +
                     count_doubtful(*along_y_, whole.size, 1, rule_) +
                     count_doubtful(*along_z_, whole.size, 2, rule_);
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

bool SolidFill::is_inside(const glm::ivec3& root_voxel) const {
    const glm::ivec3 voxel = root_voxel - whole_.origin;
    const Verdict by_x = verdict_on(along_x_.row(voxel), rule_, voxel.x);
    if (closed()) return by_x.inside;
    const Verdict by_y = verdict_on(along_y_->row(voxel), rule_, voxel.y);
    const Verdict by_z = verdict_on(along_z_->row(voxel), rule_, voxel.z);
    const int by_whole = int(by_x.whole) + int(by_y.whole) + int(by_z.whole);  // of those that say inside
    return by_whole >= 2 || (by_x.inside && by_y.inside && by_z.inside);
}

std::optional<int> SolidFill::winding_at(const glm::ivec3& root_voxel) const {
    const glm::ivec3 voxel = root_voxel - whole_.origin;
    const Row row = along_x_.row(voxel);
    if (along_x_.is_odd(voxel) || !is_whole(row)) return std::nullopt;
    int winding = 0;
    for (const RowCrossings::Event& event : row) {
        if (event.voxel() > voxel.x) break;
        winding += event.winding();
    }
    return winding;
}

void SolidFill::fill_slice(const glm::ivec3& low, int z, BitGrid& tile) const {
    for (int y = 0; y < tile.size.y; ++y) {
        std::uint32_t* const words = &tile.words[tile.word_index(0, y, z)];
        visit_inside(along_x_.row(low + glm::ivec3(0, y, z)), rule_, [&](int first, int end, bool /*whole*/) {
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
        visit_inside(along_x_.row(low + glm::ivec3(0, y, z)), rule_, [&](int first, int end, bool whole) {
            const int from = std::max(first - low.x, 0);
            const int to = std::min(end - low.x, tile.size.x);
            set_bits(&by_x.inside.words[word], from, to);
            if (whole) set_bits(&by_x.by_whole.words[word], from, to);
        });
    }
    for (int x = 0; x < tile.size.x; ++x) {
        visit_inside(along_y_->row(low + glm::ivec3(x, 0, z)), rule_, [&](int first, int end, bool whole) {
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
            const Verdict by_z = verdict_on(along_z_->row(voxel), rule_, voxel.z);
            const bool second = by_z.whole && (one >> bit & 1U) != 0;
            if (by_z.inside && (second || (both >> bit & 1U) != 0)) found |= 1U << bit;
        }
        tile.words[tile.word_index(0, 0, z) + word] |= found;
    }
}

}  // namespace cairn::voxelizer
