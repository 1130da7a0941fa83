#include "voxelizer/fill.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"

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

/// What a row says about one of its voxels.
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

}  // namespace

SolidFill::SolidFill(const Surface& surface, const Region& whole, std::size_t memory_bytes)
    : whole_(whole), along_x_(surface, whole, 0, memory_bytes) {
    // Which slices of y and of z hold doubtful rows: only there, rows along other axes are asked.
    std::vector<std::uint8_t> by_y(std::size_t(whole.size.y));
    std::vector<std::uint8_t> by_z(std::size_t(whole.size.z));
    std::atomic<std::uint64_t> count{0};
    tbb::parallel_for(0, whole.size.z, [&](int z) {
        std::uint64_t here = 0;
        for (int y = 0; y < whole.size.y; ++y) {
            if (!is_doubtful({0, y, z})) continue;
            ++here;
            std::atomic_ref(by_y[std::size_t(y)]).store(1, std::memory_order_relaxed);
        }
        by_z[std::size_t(z)] = std::uint8_t(here > 0);
        count += here;
    });
    doubtful_rows_ = count;
    if (doubtful_rows_ == 0) return;
    std::size_t left = memory_bytes - along_x_.size_bytes();
    along_y_.emplace(surface, whole, 1, left, 2, by_z);
    left -= along_y_->size_bytes();
    along_z_.emplace(surface, whole, 2, left, 1, by_y);
}

bool SolidFill::is_doubtful(const glm::ivec3& voxel) const {
    return along_x_.is_odd(voxel) || !is_whole(along_x_.row(voxel));
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
    tbb::parallel_for(0, tile.size.z, [&](int z) { fill_slice(low, z, tile); });
}

void SolidFill::fill_slice(const glm::ivec3& low, int z, BitGrid& tile) const {
    std::vector<int> doubtful;
    for (int y = 0; y < tile.size.y; ++y) {
        const glm::ivec3 first_voxel = low + glm::ivec3(0, y, z);
        if (doubtful_rows_ > 0 && is_doubtful(first_voxel)) {
            doubtful.push_back(y);
            continue;
        }
        std::uint32_t* const words = &tile.words[tile.word_index(0, y, z)];
        visit_inside(along_x_.row(first_voxel), [&](int first, int end, bool /*whole*/) {
            set_bits(words, std::max(first - low.x, 0), std::min(end - low.x, tile.size.x));
        });
    }
    if (!doubtful.empty()) fill_doubtful_rows(low, z, doubtful, tile);
}

void SolidFill::fill_doubtful_rows(const glm::ivec3& low, int z, const std::vector<int>& rows,
                                   BitGrid& tile) const {
    // What the rows along y say about this slice: most say no, and only the others are asked further.
    BitGrid inside({tile.size.x, tile.size.y, 1});
    BitGrid inside_of_whole = inside;
    for (int x = 0; x < tile.size.x; ++x) {
        visit_inside(along_y_->row(low + glm::ivec3(x, 0, z)), [&](int first, int end, bool whole) {
            for (int y = std::max(first - low.y, 0); y < std::min(end - low.y, tile.size.y); ++y) {
                inside.set({x, y, 0});
                if (whole) inside_of_whole.set({x, y, 0});
            }
        });
    }
    for (const int y : rows) {
        for (int word = 0; word < tile.words_per_row(); ++word) {
            for (std::uint32_t left = inside.words[inside.word_index(word * 32, y, 0)]; left != 0;
                 left &= left - 1) {
                const int x = word * 32 + std::countr_zero(left);
                const glm::ivec3 voxel = low + glm::ivec3(x, y, z);
                const Verdict along_z = verdict_on(along_z_->row(voxel), voxel.z);
                if (!along_z.inside) continue;
                const bool both_whole = along_z.whole && inside_of_whole.at({x, y, 0});
                if (both_whole || verdict_on(along_x_.row(voxel), voxel.x).inside) tile.set({x, y, z});
            }
        }
    }
}

}  // namespace cairn::voxelizer
