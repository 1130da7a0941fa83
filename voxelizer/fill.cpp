#include "voxelizer/fill.h"

#include <algorithm>
#include <atomic>
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

/// What a row says about one of its voxels.
struct Verdict {
    bool whole;   ///< its signs add up to 0
    bool inside;  ///< by winding if whole, else by parity
};

Verdict verdict_on(Row row, int voxel) {
    int winding = 0;
    std::size_t before = 0;
    while (before < row.size() && row[before].voxel() <= voxel)
        winding += row[before++].winding();
    const bool whole = is_whole(row);
    const bool by_parity = row.size() % 2 == 0 && before % 2 == 1;
    return {whole, whole ? winding != 0 : by_parity};
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
            if (is_whole(along_x_.row({0, y, z}))) continue;
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
        for (int y = 0; y < tile.size.y; ++y)
            fill_row(low + glm::ivec3(0, y, z), &tile.words[tile.word_index(0, y, z)], tile.size.x);
    });
}

void SolidFill::fill_row(const glm::ivec3& first, std::uint32_t* words, int count) const {
    const Row row = along_x_.row(first);
    if (doubtful_rows_ > 0 && !is_whole(row)) {
        fill_doubtful_row(first, words, count);
        return;
    }
    int winding = 0;
    int since = 0;
    for (const RowCrossings::Event& event : row) {
        const int before = winding;
        winding += event.winding();
        if (before == 0) since = event.voxel();
        if (winding == 0)
            set_bits(words, std::max(since - first.x, 0), std::min(event.voxel() - first.x, count));
    }
}

void SolidFill::fill_doubtful_row(const glm::ivec3& first, std::uint32_t* words, int count) const {
    const Row row = along_x_.row(first);
    for (int i = 0; i < count; ++i) {
        const glm::ivec3 voxel = first + glm::ivec3(i, 0, 0);
        const Verdict y = verdict_on(along_y_->row(voxel), voxel.y);
        if (!y.inside) continue;
        const Verdict z = verdict_on(along_z_->row(voxel), voxel.z);
        if (!z.inside) continue;
        if ((y.whole && z.whole) || verdict_on(row, voxel.x).inside) set_bits(words, i, i + 1);
    }
}

}  // namespace cairn::voxelizer
