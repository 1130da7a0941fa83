#include "voxelizer/solid/solid_tiles.h"

#include <utility>

namespace cairn::voxelizer {

SolidTiles::SolidTiles(const SolidFill& fill, const Grid& grid, TileSink sink, int tile_side)
    : fill_(fill),
      resolution_(grid.resolution),
      counts_(tile_counts(grid, tile_side)),
      sink_(std::move(sink)),
      side_(tile_side) {}

void SolidTiles::emit(VoxelTile&& tile) {
    fill_.add_interior(tile.origin, tile.bits);
    const std::uint64_t occupied = tile.bits.count();
    if (occupied == 0) return;
    occupied_ += occupied;
    sink_(std::move(tile));
}

void SolidTiles::skip_to(std::int64_t number) {
    for (; next_ < number; ++next_) {
        const glm::ivec3 place(next_ / (std::int64_t(counts_.y) * counts_.z), next_ % counts_.y,
                               next_ / counts_.y % counts_.z);
        const glm::ivec3 origin = place * side_;
        emit({origin, BitGrid(glm::min(glm::ivec3(side_), resolution_ - origin)), {}});
    }
}

void SolidTiles::add(VoxelTile&& tile) {
    const glm::ivec3 place = tile.origin / side_;
    skip_to((std::int64_t(place.x) * counts_.z + place.z) * counts_.y + place.y);
    ++next_;
    emit(std::move(tile));
}

void SolidTiles::finish() {
    skip_to(std::int64_t(counts_.x) * counts_.y * counts_.z);
}

}  // namespace cairn::voxelizer
