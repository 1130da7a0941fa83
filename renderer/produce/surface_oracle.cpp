#include "renderer/produce/surface_oracle.h"

#include <algorithm>
#include <bit>

#include "renderer/produce/tile_lists.h"
#include "shaders/interop/grid.h"

namespace cairn::renderer {
namespace {

/// log2 of the cells across a pyramid: that of the root is one grid of 2^24 bits (2 MiB), the others have
/// 64^3 bits.
constexpr int root_depth = 8;
constexpr int patch_depth = 6;
/// Patches that are held before they are made anew. 64^3 bits and their pyramid take about 37 KiB.
constexpr std::size_t patch_limit = 4096;

/// Level of the smallest cells that decide about a tile: the tile itself, or, if tiles are no cells, cells of
/// at most a quarter of its side.
int level_of_cells(const TreeShape& shape, int tile_level) {
    if (shape.cell_base() == 2) return shape.n_shift() * tile_level;
    const int side = shape.m * shape.voxel_side(tile_level);
    return LATTICE_BITS - int(std::bit_width(unsigned(side) / 4)) + 1;
}

}  // namespace

SurfaceOracle::SurfaceOracle(const TreeShape& shape, const voxelizer::GpuSurface& surface,
                             voxelizer::Voxelizer& voxelizer, voxelizer::TriangleIndex& lists)
    : shape_(shape),
      surface_(surface),
      voxelizer_(voxelizer),
      lists_(lists),
      list_step_(tile_list_step(shape)),
      finest_needed_(level_of_cells(shape, shape.max_level)) {}

glm::uvec2 SurfaceOracle::child_mask(const Tile& tile) {
    glm::uvec2 mask(0);
    if (tile.level >= shape_.max_level) return mask;
    drop_if_too_many();
    if (shape_.cell_base() == 3) {
        for (int child = 0; child < shape_.child_count(); ++child)
            mask.x |= may_meet(child_of(tile, 3, child)) ? 1U << child : 0U;
        return mask;
    }
    // The bits of the children; with n = 8, of their groups.
    const int across = std::min(shape_.n, 4);
    const int level = shape_.n_shift() * tile.level + (across == 2 ? 1 : 2);
    const glm::ivec3 low = glm::ivec3(tile.position) * across;
    const Patch& patch = patch_for({level, low});
    for (int child = 0; child < across * across * across; ++child) {
        const glm::ivec3 place(child % across, child / across % across, child / (across * across));
        if (patch.at({level, low + place})) mask[child / 32] |= 1U << (child % 32);
    }
    return mask;
}

bool SurfaceOracle::is_empty(const Tile& tile) {
    drop_if_too_many();
    if (shape_.cell_base() == 3) return !may_meet(tile);
    const voxelizer::Cell cell = {shape_.n_shift() * tile.level, glm::ivec3(tile.position)};
    return !patch_for(cell).at(cell);
}

bool SurfaceOracle::may_meet(const Tile& tile) {
    const int side = shape_.m * shape_.voxel_side(tile.level);
    const glm::ivec3 low = glm::ivec3(tile.position) * side;
    return may_meet({low, low + side}, {0, glm::ivec3(0)}, level_of_cells(shape_, tile.level));
}

bool SurfaceOracle::may_meet(const Box& box, const voxelizer::Cell& cell, int finest) {
    if (!patch_for(cell).at(cell)) return false;
    if (cell.level == finest) return true;
    // Cells that share more with the box than their faces: a point on a face belongs to the cells on both
    // sides.
    const int shift = LATTICE_BITS - cell.level - 1;
    const glm::ivec3 first = glm::max(box.low >> shift, cell.position * 2);
    const glm::ivec3 last = glm::min((box.high - 1) >> shift, cell.position * 2 + 1);
    for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                if (may_meet(box, {cell.level + 1, {x, y, z}}, finest)) return true;
            }
        }
    }
    return false;
}

void SurfaceOracle::drop_if_too_many() {
    if (patches_.size() > patch_limit) patches_.clear();
}

const SurfaceOracle::Patch& SurfaceOracle::patch_for(const voxelizer::Cell& cell) {
    // The pyramids start at levels 0, d0, d0 + d1, ... so that each cell has one place to look.
    int start = 0;
    int depth = root_depth - root_depth % list_step_;
    while (cell.level > start + depth) {
        start += depth;
        depth = patch_depth - patch_depth % list_step_;
    }
    const voxelizer::Cell owner{start, cell.position >> (cell.level - start)};
    if (const auto found = patches_.find(owner); found != patches_.end()) return found->second;

    Patch patch;
    patch.cell = owner;
    patch.finest = std::min(start + depth, finest_needed_);
    const int side = 1 << (patch.finest - start);
    const voxelizer::Region region{patch.finest, owner.position * side, glm::ivec3(side)};
    if (owner.level == 0) {
        patch.pyramid = voxelizer_.voxelize_pyramid(surface_, region);
    } else {
        patch.pyramid = voxelizer_.voxelize_pyramid(surface_, region, lists_.list(owner));
    }
    return patches_.emplace(owner, std::move(patch)).first->second;
}

}  // namespace cairn::renderer
