#include "voxelizer/methods/raster_tiles.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "shaders/interop/grid.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/methods/slice_targets.h"

namespace cairn::voxelizer {
namespace {

constexpr int max_side = RASTER_TARGETS * RASTER_TARGET_SLICES;

/// Voxels from the region's low corner, along one axis.
struct Range {
    std::int64_t first, end;
};

/// The range that surfaces can reach: vertices lie within [-2^24, 2^25].
Range reachable(const Region& region, int axis) {
    const std::int64_t cube = std::int64_t(1) << region.level;
    const std::int64_t origin = region.origin[axis];
    Range range{std::max<std::int64_t>(-cube - 1 - origin, 0),
                std::min<std::int64_t>(2 * cube + 1 - origin, region.size[axis])};
    if (axis == 0) range.first = range.first / 32 * 32;
    return range;
}

bool too_large(const RasterTile& tile, int directions, std::size_t target_bytes) {
    return tile.longest_side() > max_side ||
           SliceTargets::bytes(tile.plane(directions), directions, tile.slices(directions)) > target_bytes;
}

/// Halves the longest side until the tile fits, or is a cube of the least side: sides stay multiples of 32,
/// as rows need.
glm::ivec3 tile_size(const glm::ivec3& all, int directions, std::size_t target_bytes) {
    RasterTile tile;
    tile.size = all;
    while (too_large(tile, directions, target_bytes)) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis) {
            if (tile.size[axis] > tile.size[longest]) longest = axis;
        }
        if (tile.size[longest] <= 32) break;
        tile.size[longest] = ((tile.size[longest] + 1) / 2 + 31) / 32 * 32;
    }
    return tile.size;
}

RasterTile tile_at(const Region& region, const glm::ivec3& place, const glm::ivec3& size) {
    RasterTile tile;
    tile.place = place;
    tile.size = size;
    tile.voxel_shift = LATTICE_BITS - region.level;
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t low = std::int64_t(region.origin[axis]) + place[axis];
        tile.lattice_low[axis] = int(low << tile.voxel_shift);
        const std::int64_t end = std::int64_t(region.size[axis] - place[axis]) << tile.voxel_shift;
        tile.region_end[axis] = int(std::min(end, most));
    }
    return tile;
}

}  // namespace

glm::ivec2 RasterTile::plane(int directions) const {
    if (directions == 1) return {size.x, size.y};
    return {std::max(size.x, std::min(size.y, size.z)), std::max(size.y, size.z)};
}

int RasterTile::slices(int directions) const {
    return directions == 1 ? size.z : longest_side();
}

int RasterTile::longest_side() const {
    return std::max({size.x, size.y, size.z});
}

std::vector<RasterTile> raster_tiles(const Region& region, int directions, std::size_t target_bytes) {
    glm::ivec3 first(0);
    glm::ivec3 end(0);
    for (int axis = 0; axis < 3; ++axis) {
        const Range range = reachable(region, axis);
        if (range.first >= range.end) return {};
        first[axis] = int(range.first);
        end[axis] = int(range.end);
    }
    const glm::ivec3 step = tile_size(end - first, directions, target_bytes);
    std::vector<RasterTile> tiles;
    for (int z = first.z; z < end.z; z += step.z) {
        for (int y = first.y; y < end.y; y += step.y) {
            for (int x = first.x; x < end.x; x += step.x) {
                const glm::ivec3 place(x, y, z);
                tiles.push_back(tile_at(region, place, glm::min(step, end - place)));
            }
        }
    }
    return tiles;
}

}  // namespace cairn::voxelizer
