#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "gl/shader_source.h"

namespace cairn::renderer {

/// The most that TreeShape::window_tile_bits can be (WINDOW_TILE_BITS in the shaders).
constexpr int max_window_tile_bits = 16;

/// What rays meet in an occupied voxel of a surface (shaders/march/march.glsl). With N = 3 it is `voxel`.
enum class VoxelGeometry : std::uint8_t {
    voxel = 0,  ///< the voxel, by its coverage
    marks = 1,  ///< its marks: the finer voxels, 4^3 in each, that the surface meets
    slabs = 2,  ///< its slab: two planes that hold the surface; else the whole voxel
    both = 3,   ///< what lies in its slab and in its marks
};

/// The parameters of an N^3-tree with M^3 bricks (Crassin et al. 2008, section 4.1). Both are powers of one
/// base, 2 or 3, so that all cells of the tree and of its bricks nest.
struct TreeShape {
    /// Children per axis: 2, 3, 4 or 8.
    int n = 4;
    /// Voxels of a brick per axis, without the border: 8, 16, 32 or 64; 27 or 81 if n = 3.
    int m = 16;
    /// Level of the finest tiles; the root is level 0.
    int max_level = 4;
    /// Mip levels of a brick beside its own voxels, each twice as coarse as the one before: 0 or n_shift().
    int mips = 0;
    /// For trees that rays go through in windows: log2 of the most voxels across a window's tile, in
    /// [m_shift(), max_window_tile_bits].
    int window_tile_bits = max_window_tile_bits;
    VoxelGeometry geometry = VoxelGeometry::both;

    /// The base whose powers n and m are; their exponents are n_shift() and m_shift().
    [[nodiscard]] int cell_base() const { return n == 3 ? 3 : 2; }
    [[nodiscard]] int n_shift() const { return n == 8 ? 3 : n == 4 ? 2 : 1; }
    [[nodiscard]] int m_shift() const {
        return m == 8 || m == 27 ? 3 : m == 16 || m == 81 ? 4 : m == 32 ? 5 : 6;
    }
    /// Voxels of a mip along an axis of a brick, border included.
    [[nodiscard]] int mip_side(int mip) const { return (m >> mip) + 2; }
    [[nodiscard]] int child_count() const { return n * n * n; }
    /// log2 of the voxels across the root cube at a level. Without a meaning if n = 3.
    [[nodiscard]] int voxel_level(int level) const { return m_shift() + n_shift() * level; }
    /// Tiles of a level across a tile that is `levels` levels above it.
    [[nodiscard]] int tiles_across(int levels) const;
    /// Voxels across the root cube at the finest level.
    [[nodiscard]] int resolution() const { return m * tiles_across(max_level); }
    /// Lattice units across a voxel of a level (voxelizer/grid.h). The root of the tree fills the root cube
    /// of the lattice, unless n = 3: then it is the low corner of that cube.
    [[nodiscard]] int voxel_side(int level) const;
    /// Side, in voxels, of a mask block: the cube of voxels that one word of a brick's masks covers.
    [[nodiscard]] int block_side() const { return n == 3 ? 3 : 4; }
    /// Mask blocks of a mip; 1 if the mip has fewer voxels than a block.
    [[nodiscard]] int blocks(int mip = 0) const {
        const int across = (m >> mip) > block_side() ? (m >> mip) / block_side() : 1;
        return across * across * across;
    }
    /// 64-bit words of the summary, which marks the mask blocks that are not empty: one bit per block of
    /// mip 0.
    [[nodiscard]] int summary_words() const { return (blocks() + 63) / 64; }
    /// 64-bit words of a brick's masks: the summary, then one word per mask block, mip after mip.
    [[nodiscard]] int mask_words() const {
        int words = summary_words();
        for (int mip = 0; mip <= mips; ++mip)
            words += blocks(mip);
        return words;
    }
    /// Voxels of a mip's border, one voxel wide on each side.
    [[nodiscard]] int border_voxels(int mip) const {
        const int inner = m >> mip;
        return mip_side(mip) * mip_side(mip) * mip_side(mip) - inner * inner * inner;
    }
    /// Groups of voxels of a packed brick (renderer/pool/packed_bricks.h), whose occupancy is one 64-bit word
    /// each: first the mask blocks of all mips, then the borders of all mips, 64 voxels in a group.
    [[nodiscard]] int groups() const {
        int groups = inner_groups();
        for (int mip = 0; mip <= mips; ++mip)
            groups += (border_voxels(mip) + 63) / 64;
        return groups;
    }
    /// Groups that are mask blocks.
    [[nodiscard]] int inner_groups() const { return mask_words() - summary_words(); }
    /// 32-bit words at the start of a packed brick, before its records.
    [[nodiscard]] int head_words() const { return 2 * (summary_words() + groups()) + groups() + 1; }
    /// Has the tree too many voxels for a ray to count? Then rays go through windows
    /// (renderer/march/windows.h), and resolution() has no meaning. False if n = 3.
    [[nodiscard]] bool has_windows() const;
    /// Levels under the tiles of a window that a ray can reach.
    [[nodiscard]] int levels_in_window() const;
    /// Macros for shaders: the numbers above by the same names in capitals, MAX_LEVEL (counted from the tiles
    /// of a window if there are windows), WINDOWS, GEOMETRY and HAS_COLOR.
    [[nodiscard]] gl::Defines defines(bool has_color) const;
};

/// The least shape with at least `voxels` voxels across the root cube. A root cube has m n^k voxels across,
/// so that a content that is less than m n^k voxels wide lies in its low corner.
/// @param with_mips  bricks hold mip levels up to the size of their parent's voxels. Not with n = 3, which
///                   cuts voxels in thirds and not in halves.
/// @throws Error (Fault::usage) if n, m or the voxels are out of range; names the range.
[[nodiscard]] TreeShape make_tree_shape(int n, int m, int voxels, bool with_mips = false);

/// The deepest shape with at most `voxels` voxels across the root cube, for contents that fill that cube.
/// @throws Error (Fault::usage) if n, m or the voxels are out of range; names the range.
[[nodiscard]] TreeShape make_tree_shape_within(int n, int m, int voxels);

/// A shape of any depth, whose finest voxels may be 2^-60 of the root cube.
/// @throws Error (Fault::usage) if n, m or the level is out of range; names the range.
[[nodiscard]] TreeShape make_deep_tree_shape(int n, int m, int max_level);

/// The most voxels across a root cube whose rays count them one by one: m n^k for the greatest k that
/// make_tree_shape() takes.
[[nodiscard]] int most_voxels_across(int n, int m);

/// The most levels under the root that make_deep_tree_shape() takes for n and m.
[[nodiscard]] int deepest_level(int n, int m);

/// The shape of the N^3-tree that a content is made for (Crassin et al. 2008, section 4), as a caller asks
/// for it.
struct TreeOptions {
    /// Children of a node per axis: 2, 3, 4 or 8.
    int n = 4;
    /// Voxels of a brick per axis, without the border: 8, 16, 32 or 64; 27 or 81 with n = 3.
    int m = 16;
    /// Voxels across the content that rays may ask for, in [m, most_voxels_across()]. Surfaces have exactly
    /// as many across their grid (voxelizer::grid_around()), and at most 2^19 across the root cube; volumes
    /// and sets at most as many (ContentSource::finest_resolution()).
    int max_resolution = 8192;
    /// Bricks hold mip levels, for LevelOfDetail::Kind::blended, and take about a third more memory. For
    /// surfaces only, and not with n = 3.
    bool mips = false;
    /// Levels under the root, instead of max_resolution: for contents without a finest level. The finest
    /// voxels are at least 2^-60 of the root cube.
    std::optional<int> max_level = std::nullopt;
    /// What rays meet in the voxels of surfaces. `both` is the most exact and takes the least memory; the
    /// others are there to be measured beside it.
    VoxelGeometry geometry = VoxelGeometry::both;
    bool operator==(const TreeOptions&) const = default;
};

/// make_tree_shape(), or make_deep_tree_shape() if `max_level` is given.
/// @throws Error (Fault::usage) if an option is out of range, or if a tree with `max_level` has mips.
[[nodiscard]] TreeShape tree_shape_of(const TreeOptions& options);

/// The bounds, in bytes, of the tree's two stores on the GPU, and of the bricks that main memory keeps beside
/// them (Crassin et al. 2008, section 4.2).
struct PoolSizes {
    std::size_t node_bytes = std::size_t(8) << 20U;
    std::size_t brick_bytes = std::size_t(256) << 20U;
    /// Main memory for bricks that had to leave the brick pool, so that they need not be produced again. 0:
    /// such bricks are not kept.
    std::size_t cache_bytes = 0;
    bool operator==(const PoolSizes&) const = default;
};

/// What a voxel of a brick has beside its coverage (of a volume: its density).
struct Channels {
    bool color = false;
    bool normal = true;
    /// Bricks keep the voxels that are occupied, and no others (renderer/pool/packed_bricks.h).
    bool packed = false;
};

/// A region of the regular subdivision: level 0 is the root cube, level l has n^l tiles across it.
struct Tile {
    int level = 0;
    /// In tiles of the level: a path of child numbers, so that any depth is exact.
    glm::i64vec3 position{0};

    [[nodiscard]] bool operator==(const Tile&) const = default;
};

/// For maps keyed by tiles.
struct TileHash {
    [[nodiscard]] std::size_t operator()(const Tile& tile) const {
        std::uint64_t h = std::uint64_t(tile.level + 1) * 0xD6E8FEB86659FD93U;
        for (int axis = 0; axis < 3; ++axis) {
            h = (h ^ std::uint64_t(tile.position[axis])) * 0x9E3779B97F4A7C15U;
            h ^= h >> 29U;
        }
        return std::size_t(h);
    }
};

/// Child number x + n (y + n z), as in NodeEntry.child_mask.
[[nodiscard]] inline Tile child_of(const Tile& tile, int n, int child) {
    const glm::i64vec3 place(child % n, child / n % n, child / (n * n));
    return {tile.level + 1, tile.position * std::int64_t(n) + place};
}
/// The bit of NodeEntry.child_mask that stands for a child. With n = 8 it stands for a group of 2^3 children.
[[nodiscard]] inline int mask_bit(int n, int child) {
    return n == 8 ? child % 8 / 2 + 4 * (child / 8 % 8 / 2) + 16 * (child / 64 / 2) : child;
}
/// May this child hold something, as far as the mask says?
[[nodiscard]] inline bool may_hold(const glm::uvec2& child_mask, int n, int child) {
    const int bit = mask_bit(n, child);
    return (child_mask[bit / 32] >> (bit % 32) & 1U) != 0;
}

}  // namespace cairn::renderer
