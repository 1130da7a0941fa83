#include "voxelizer/solid/voxel_runs.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "voxelizer/solid/word_bits.h"

namespace cairn::voxelizer {
namespace {

bool is_before(const VoxelRun& a, const VoxelRun& b) {
    return std::tuple(a.first.z, a.first.y, a.first.x) < std::tuple(b.first.z, b.first.y, b.first.x);
}

}  // namespace

void VoxelRuns::add(const glm::ivec3& tile_origin, const BitGrid& tile) {
    for (int z = 0; z < tile.size.z; ++z) {
        for (int y = 0; y < tile.size.y; ++y) {
            int open = -1;  // where a run began that goes on
            for (int x = 0; x < tile.size.x; x += 32) {
                const std::uint32_t word = tile.words[tile.word_index(x, y, z)];
                for (int bit = 0; bit < 32;) {
                    const std::uint32_t left = word >> bit;
                    if (open < 0) {
                        if (left == 0) break;
                        bit += std::countr_zero(left);
                        open = x + bit;
                    } else {
                        bit += std::countr_one(left);
                        if (bit >= 32) break;
                        runs_.push_back({tile_origin + glm::ivec3(open, y, z), x + bit - open});
                        open = -1;
                    }
                }
            }
            if (open >= 0) runs_.push_back({tile_origin + glm::ivec3(open, y, z), tile.size.x - open});
        }
    }
}

void VoxelRuns::sort() {
    std::ranges::sort(runs_, is_before);
    std::size_t kept = 0;
    for (const VoxelRun& run : runs_) {
        VoxelRun* const last = kept > 0 ? &runs_[kept - 1] : nullptr;
        if (last != nullptr && last->first.z == run.first.z && last->first.y == run.first.y &&
            last->end() == run.first.x) {
            last->length += run.length;
        } else {
            runs_[kept++] = run;
        }
    }
    runs_.resize(kept);
}

std::span<const VoxelRun> VoxelRuns::row(int y, int z) const {
    const auto is_before_row = [](const VoxelRun& run, const std::pair<int, int>& row) {
        return std::pair(run.first.z, run.first.y) < row;
    };
    const auto first = std::lower_bound(runs_.begin(), runs_.end(), std::pair(z, y), is_before_row);
    const auto last = std::lower_bound(first, runs_.end(), std::pair(z, y + 1), is_before_row);
    return {runs_.data() + (first - runs_.begin()), std::size_t(last - first)};
}

void VoxelRuns::copy_run(const VoxelRun& run, const glm::ivec3& tile_origin, const glm::ivec3& row,
                         BitGrid& tile) {
    set_bits(&tile.words[tile.word_index(0, row.y, row.z)], std::max(run.first.x - tile_origin.x, 0),
             std::min(run.end() - tile_origin.x, tile.size.x));
}

}  // namespace cairn::voxelizer
