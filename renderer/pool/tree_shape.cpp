#include "renderer/pool/tree_shape.h"

#include <bit>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/pool.h"
#include "shaders/interop/windows.h"

namespace cairn::renderer {

static_assert(max_window_tile_bits == WINDOW_TILE_BITS, "the shaders have other windows");
static_assert(int(VoxelGeometry::marks) == GEOMETRY_MARKS && int(VoxelGeometry::slabs) == GEOMETRY_SLABS &&
              int(VoxelGeometry::both) == (GEOMETRY_MARKS | GEOMETRY_SLABS));

/// Positions of voxels and their borders stay within 63 bits.
constexpr int most_voxel_bits = 60;

gl::Defines TreeShape::defines(bool has_color) const {
    return {{"TREE_N", std::to_string(n)},
            {"BRICK_M", std::to_string(m)},
            {"BRICK_MIPS", std::to_string(mips)},
            {"CELL_BASE", std::to_string(cell_base())},
            {"N_SHIFT", std::to_string(n_shift())},
            {"M_SHIFT", std::to_string(m_shift())},
            {"BLOCK_SIDE", std::to_string(block_side())},
            {"BLOCKS", std::to_string(blocks())},
            {"SUMMARY_WORDS", std::to_string(summary_words())},
            {"MASK_WORDS", std::to_string(mask_words())},
            {"GROUPS", std::to_string(groups())},
            {"MAX_LEVEL", std::to_string(has_windows() ? levels_in_window() : max_level)},
            {"WINDOWS", has_windows() ? "1" : "0"},
            {"GEOMETRY", std::to_string(int(geometry))},
            {"HAS_COLOR", has_color ? "1" : "0"}};
}

int TreeShape::tiles_across(int levels) const {
    int across = 1;
    for (int level = 0; level < levels; ++level)
        across *= n;
    return across;
}

int TreeShape::voxel_side(int level) const {
    const auto finest = std::bit_ceil(unsigned(resolution()));
    return int((1U << unsigned(LATTICE_BITS)) / finest) * tiles_across(max_level - level);
}

bool TreeShape::has_windows() const {
    return cell_base() == 2 && voxel_level(max_level) > MAX_RESOLUTION_BITS;
}

int TreeShape::levels_in_window() const {
    return (window_tile_bits - m_shift()) / n_shift();
}

namespace {

void check_factors(int n, int m) {
    if (n != 2 && n != 3 && n != 4 && n != 8) {
        throw Error(Fault::usage, "tree", fmt::format("N = {} is not 2, 3, 4 or 8", n));
    }
    if (n == 3 && m != 27 && m != 81) {
        throw Error(Fault::usage, "tree", fmt::format("M = {} is not 27 or 81", m),
                    "with N = 3, bricks are cut in thirds too; M = 8, 16, 32 and 64 go with N = 2, 4 and 8");
    }
    if (n != 3 && m != 8 && m != 16 && m != 32 && m != 64) {
        throw Error(Fault::usage, "tree", fmt::format("M = {} is not 8, 16, 32 or 64", m),
                    "M = 27 and 81 go with N = 3");
    }
}

void check_voxels(int voxels, int m, int most) {
    if (voxels >= m && voxels <= most) return;
    throw Error(Fault::usage, "maximum resolution",
                fmt::format("{} is not between {} (one brick) and {}", voxels, m, most));
}

}  // namespace

TreeShape make_tree_shape_within(int n, int m, int voxels) {
    check_factors(n, m);
    check_voxels(voxels, m, 1 << MAX_RESOLUTION_BITS);
    TreeShape shape{.n = n, .m = m, .max_level = 0};
    while (std::int64_t(shape.resolution()) * n <= voxels)
        ++shape.max_level;
    return shape;
}

int most_voxels_across(int n, int m) {
    return make_tree_shape_within(n, m, 1 << MAX_RESOLUTION_BITS).resolution();
}

TreeShape make_tree_shape(int n, int m, int voxels, bool with_mips) {
    check_factors(n, m);
    if (with_mips && n == 3) {
        throw Error(Fault::usage, "tree", "bricks have no mip levels with N = 3",
                    "choose N = 2, 4 or 8, or leave the mips out");
    }
    check_voxels(voxels, m, most_voxels_across(n, m));
    TreeShape shape = make_tree_shape_within(n, m, voxels);
    if (shape.resolution() < voxels) ++shape.max_level;
    shape.mips = with_mips ? shape.n_shift() : 0;
    return shape;
}

int deepest_level(int n, int m) {
    check_factors(n, m);
    const TreeShape shape{.n = n, .m = m};
    return (most_voxel_bits - shape.m_shift()) / shape.n_shift();
}

TreeShape make_deep_tree_shape(int n, int m, int max_level) {
    check_factors(n, m);
    const TreeShape shape{.n = n, .m = m, .max_level = max_level};
    const int most = deepest_level(n, m);
    if (max_level < 0 || max_level > most) {
        throw Error(Fault::usage, "tree", fmt::format("{} levels are not between 0 and {}", max_level, most));
    }
    return shape;
}

TreeShape tree_shape_of(const TreeOptions& options) {
    if (!options.max_level) {
        TreeShape shape = make_tree_shape(options.n, options.m, options.max_resolution, options.mips);
        shape.geometry = options.geometry;
        return shape;
    }
    if (options.mips) {
        throw Error(Fault::usage, "tree", "bricks of a tree of any depth have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
    TreeShape shape = make_deep_tree_shape(options.n, options.m, *options.max_level);
    shape.geometry = options.geometry;
    return shape;
}

}  // namespace cairn::renderer
