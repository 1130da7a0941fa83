#include "voxelizer/solid/solid_tiles.h"

#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"

namespace cairn::voxelizer {

SolidTiles::SolidTiles(const Surface& surface, const Grid& grid, const SolidOptions& options, int tile_side)
    : resolution_(grid.resolution),
      counts_(tile_counts(grid, tile_side)),
      side_(tile_side),
      memory_bytes_(options.memory_bytes) {
    if (options.rule != SolidRule::outside) crossings_.emplace(surface, whole(grid), options);
    outside_.emplace(surface, whole(grid), options.memory_bytes);
}

VoxelTile SolidTiles::empty_tile(std::int64_t number) const {
    const glm::ivec3 place(number / (std::int64_t(counts_.y) * counts_.z), number % counts_.y,
                           number / counts_.y % counts_.z);
    const glm::ivec3 origin = place * side_;
    return {origin, BitGrid(glm::min(glm::ivec3(side_), resolution_ - origin)), {}};
}

std::int64_t SolidTiles::number_of(const VoxelTile& tile) const {
    const glm::ivec3 place = tile.origin / side_;
    return (std::int64_t(place.x) * counts_.z + place.z) * counts_.y + place.y;
}

void SolidTiles::emit(VoxelTile&& tile, const TileSink& sink) {
    if (crossings_) crossings_->add_interior(tile.origin, tile.bits);
    const std::uint64_t occupied = tile.bits.count();
    if (occupied == 0) return;
    occupied_ += occupied;
    sink(std::move(tile));
}

void SolidTiles::skip_to(std::int64_t number, const TileSink& sink) {
    for (; next_ < number; ++next_)
        emit(empty_tile(next_), sink);
}

void SolidTiles::add(VoxelTile&& tile, const TileSink& sink) {
    if (outside_ && !outside_->add_surface(tile.origin, tile.bits)) {
        if (!crossings_) {
            throw Error(Fault::memory, "solid fill",
                        fmt::format("what the outside reaches of {} x {} x {} voxels takes more than the {} "
                                    "MiB allowed",
                                    resolution_.x, resolution_.y, resolution_.z, memory_bytes_ >> 20),
                        "choose fewer voxels, or to fill by winding");
        }
        outside_.reset();
    }
    if (!crossings_) return;
    skip_to(number_of(tile), sink);
    ++next_;
    emit(std::move(tile), sink);
}

void SolidTiles::finish(const TileSink& sink) {
    if (outside_) outside_->flood();
    if (crossings_) {
        skip_to(tile_count(), sink);
        return;
    }
    for (; next_ < tile_count(); ++next_) {
        VoxelTile tile = empty_tile(next_);
        tile.bits = outside_->solid(tile.origin, tile.bits.size);
        emit(std::move(tile), sink);
    }
}

std::optional<Doubts> SolidTiles::find_doubts(const TileSink& sink) const {
    if (!outside_) return std::nullopt;
    Doubts doubts;
    if (!crossings_) return doubts;
    for (std::int64_t number = 0; number < tile_count(); ++number) {
        VoxelTile tile = empty_tile(number);
        BitGrid interior(tile.bits.size);
        crossings_->add_interior(tile.origin, interior);
        const BitGrid reached = outside_->reached(tile.origin, interior.size);
        const BitGrid enclosed = outside_->enclosed(tile.origin, interior.size);
        const auto words = std::size_t(interior.words_per_row());
        for (std::size_t i = 0; i < interior.words.size(); ++i) {
            const std::uint32_t open = reached.words[i] & interior.words[i];
            std::uint32_t doubtful = open;
            const auto row = int(i / words);
            for (std::uint32_t left = enclosed.words[i] & ~interior.words[i]; left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                const glm::ivec3 voxel(int(i % words) * 32 + bit, row % interior.size.y,
                                       row / interior.size.y);
                if (crossings_->is_doubtful_cavity(tile.origin + voxel)) doubtful |= 1U << bit;
            }
            tile.bits.words[i] = doubtful;
            doubts.reached += std::uint64_t(std::popcount(open));
            doubts.enclosed += std::uint64_t(std::popcount(doubtful & ~open));
        }
        if (sink && tile.bits.count() > 0) sink(std::move(tile));
    }
    return doubts;
}

}  // namespace cairn::voxelizer
