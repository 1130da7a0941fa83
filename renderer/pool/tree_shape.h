#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#include "gl/shader_source.h"

namespace cairn::renderer {

/// The most that TreeShape::window_tile_bits can be (WINDOW_TILE_BITS in the shaders).
constexpr int max_window_tile_bits = 16;

/// The parameters of an N^3-tree with M^3 bricks (Crassin et al. 2008, section 4.1). Both are powers of one
/// base, 2 or 3, so that all cells of the tree and of its bricks nest.
struct TreeShape {
    int n = 4;   ///< children an axis: 2, 3, 4 or 8
    int m = 16;  ///< voxels of a brick an axis, border not counted: 8, 16, 32 or 64; 27 or 81 where n = 3
    int max_level = 4;  ///< level of the finest tiles; the root is level 0
    int mips = 0;       ///< mip levels of a brick beside its own voxels, each twice as coarse: 0 or n_shift()
    /// Where rays go through windows, log2 of a tile's side in voxels there, at most: [m_shift(),
    /// max_window_tile_bits].
    int window_tile_bits = max_window_tile_bits;

    /// What n and m are powers of, which are called their shifts.
    [[nodiscard]] int cell_base() const { return n == 3 ? 3 : 2; }
    [[nodiscard]] int n_shift() const { return n == 8 ? 3 : n == 4 ? 2 : 1; }
    [[nodiscard]] int m_shift() const {
        return m == 8 || m == 27 ? 3 : m == 16 || m == 81 ? 4 : m == 32 ? 5 : 6;
    }
    /// Voxels of a mip along an axis of a brick, border included.
    [[nodiscard]] int mip_side(int mip) const { return (m >> mip) + 2; }
    [[nodiscard]] int child_count() const { return n * n * n; }
    /// Voxels across the root cube at a level: log2. Not where n = 3.
    [[nodiscard]] int voxel_level(int level) const { return m_shift() + n_shift() * level; }
    /// Tiles of a level across one that is so many levels above it.
    [[nodiscard]] int tiles_across(int levels) const;
    /// Voxels across the root cube at the finest level.
    [[nodiscard]] int resolution() const { return m * tiles_across(max_level); }
    /// Lattice units across a voxel of a level (voxelizer/grid.h). The tree's root is the low corner of the
    /// lattice's root cube: all of it, unless n = 3.
    [[nodiscard]] int voxel_side(int level) const;
    /// Side of the cube of voxels that one word of a brick's masks tells of.
    [[nodiscard]] int block_side() const { return n == 3 ? 3 : 4; }
    /// Such cubes in a mip; where it has fewer voxels, one.
    [[nodiscard]] int blocks(int mip = 0) const {
        const int across = (m >> mip) > block_side() ? (m >> mip) / block_side() : 1;
        return across * across * across;
    }
    /// 64-bit words that say which blocks of a brick are not empty, one bit per block of mip 0.
    [[nodiscard]] int summary_words() const { return (blocks() + 63) / 64; }
    /// 64-bit words of a brick's masks: the summary, then a word per block, mip after mip.
    [[nodiscard]] int mask_words() const {
        int words = summary_words();
        for (int mip = 0; mip <= mips; ++mip)
            words += blocks(mip);
        return words;
    }
    /// Too many voxels for a ray to count: it goes through windows (renderer/march/windows.h), and
    /// resolution() has no meaning. Never where n = 3.
    [[nodiscard]] bool has_windows() const;
    /// Levels under a window's tiles that a ray can reach.
    [[nodiscard]] int levels_in_window() const;
    /// For shaders: the numbers above by the same names in capitals, MAX_LEVEL (in a window where there are
    /// windows), WINDOWS and HAS_COLOR.
    [[nodiscard]] gl::Defines defines(bool has_color) const;
};

/// The deepest shape whose voxels do not pass `max_resolution` across the root cube.
/// @param with_mips  bricks hold mip levels up to the size of their parent's voxels. Not with n = 3, whose
/// voxels are not cut in halves.
/// @throws Error (Fault::usage) when n, m or the resolution cannot work; says which values can.
[[nodiscard]] TreeShape make_tree_shape(int n, int m, int max_resolution, bool with_mips = false);

/// A shape of any depth, whose finest voxels may be 2^-60 of the root cube.
/// @throws Error (Fault::usage) likewise.
[[nodiscard]] TreeShape make_deep_tree_shape(int n, int m, int max_level);

/// The most levels under the root that make_deep_tree_shape() takes for n and m.
[[nodiscard]] int deepest_level(int n, int m);

/// A region of the regular subdivision: level 0 is the root cube, level l has n^l tiles across it.
struct Tile {
    int level = 0;
    glm::i64vec3 position{0};  ///< in tiles of its level: a path of child numbers, so any depth is exact

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
/// The bit of NodeEntry.child_mask that tells of a child. With n = 8 it stands for a group of 2^3.
[[nodiscard]] inline int mask_bit(int n, int child) {
    return n == 8 ? child % 8 / 2 + 4 * (child / 8 % 8 / 2) + 16 * (child / 64 / 2) : child;
}
/// Does the mask leave open that this child holds something?
[[nodiscard]] inline bool may_hold(const glm::uvec2& child_mask, int n, int child) {
    const int bit = mask_bit(n, child);
    return (child_mask[bit / 32] >> (bit % 32) & 1U) != 0;
}

}  // namespace cairn::renderer
