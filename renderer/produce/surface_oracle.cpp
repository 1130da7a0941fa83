#include "renderer/produce/surface_oracle.h"

#include <algorithm>

#include "renderer/produce/tile_lists.h"

namespace cairn::renderer {
namespace {

/// Levels of a pyramid, as log2 of voxels across its tile: the root's is one grid of 2^24 bits (2 MiB), the
/// others 64^3.
constexpr int root_depth = 8;
constexpr int patch_depth = 6;
/// Patches held before they are made anew: 64^3 bits and their pyramid are about 37 KiB.
constexpr std::size_t patch_limit = 4096;

}  // namespace

SurfaceOracle::SurfaceOracle(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                             voxelizer::Voxelizer& voxelizer, voxelizer::TriangleIndex& lists)
    : shape_(shape), surface_(surface), voxelizer_(voxelizer), lists_(lists) {}

glm::uvec2 SurfaceOracle::child_mask(const Tile& tile) {
    if (tile.level >= shape_.max_level) return glm::uvec2(0);
    const Patch& patch = patch_for(tile);
    const int n = shape_.n;
    const int children_level = shape_.n_shift() * (tile.level + 1);
    const voxelizer::BitGrid& bits = patch.pyramid.level(patch.finest - children_level);
    const glm::ivec3 patch_low = glm::ivec3(patch.tile.position)
                                 << (children_level - shape_.n_shift() * patch.tile.level);
    glm::uvec2 mask(0);
    for (int child = 0; child < shape_.child_count(); ++child) {
        if (!bits.at(glm::ivec3(child_of(tile, n, child).position) - patch_low)) continue;
        mask[child / 32] |= 1U << (child % 32);
    }
    return mask;
}

const SurfaceOracle::Patch& SurfaceOracle::patch_for(const Tile& tile) {
    // The pyramids start at tile levels 0, d0, d0 + d1, ... so that each tile has one place to look.
    const int finest_needed = shape_.n_shift() * shape_.max_level;
    int start = 0;
    int depth = root_depth - root_depth % shape_.n_shift();
    while (shape_.n_shift() * (tile.level + 1) > start + depth) {
        start += depth;
        depth = patch_depth - patch_depth % shape_.n_shift();
    }
    const int start_level = start / shape_.n_shift();
    const Tile owner{start_level,
                     tile.position >> std::int64_t(shape_.n_shift() * (tile.level - start_level))};
    if (const auto found = patches_.find(owner); found != patches_.end()) return found->second;

    if (patches_.size() > patch_limit) patches_.clear();
    Patch patch;
    patch.tile = owner;
    patch.finest = std::min(start + depth, finest_needed);
    const int side = 1 << (patch.finest - start);
    const voxelizer::Region region{patch.finest, glm::ivec3(owner.position) * side, glm::ivec3(side)};
    if (owner.level == 0) {
        patch.pyramid = voxelizer_.voxelize_pyramid(surface_, region);
    } else {
        patch.pyramid = voxelizer_.voxelize_pyramid(surface_, region, lists_.list(cell_of(owner, shape_)));
    }
    return patches_.emplace(owner, std::move(patch)).first->second;
}

}  // namespace cairn::renderer
