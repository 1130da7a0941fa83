#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#include "gl/shader_source.h"

namespace cairn::renderer {

/// The parameters of an N^3-tree with M^3 bricks (Crassin et al. 2008, section 4.1). Powers of two, so that
/// tiles lie on the voxelizer's lattice.
struct TreeShape {
    int n = 4;          ///< children an axis: 2 or 4
    int m = 16;         ///< voxels of a brick an axis, border not counted: 8, 16, 32 or 64
    int max_level = 4;  ///< level of the finest tiles; the root is level 0
    int mips = 0;       ///< mip levels of a brick beside its own voxels, each twice as coarse: 0 or n_shift()

    [[nodiscard]] int n_shift() const { return n == 4 ? 2 : 1; }
    [[nodiscard]] int m_shift() const { return m == 8 ? 3 : m == 16 ? 4 : m == 32 ? 5 : 6; }
    /// Voxels of a mip along an axis of a brick, border included.
    [[nodiscard]] int mip_side(int mip) const { return (m >> mip) + 2; }
    /// Blocks of 4^3 voxels along an axis of a mip; where there are fewer voxels, one.
    [[nodiscard]] int mip_blocks_a_side(int mip) const { return (m >> mip) > 4 ? (m >> mip) / 4 : 1; }
    [[nodiscard]] int child_count() const { return n * n * n; }
    /// Voxels across the root cube at a level: log2.
    [[nodiscard]] int voxel_level(int level) const { return m_shift() + n_shift() * level; }
    /// Voxels across the root cube at the finest level.
    [[nodiscard]] int resolution() const { return 1 << voxel_level(max_level); }
    [[nodiscard]] gl::Defines defines(bool has_color) const;
};

/// The deepest shape whose voxels do not pass `max_resolution` across the root cube.
/// @param with_mips  bricks hold mip levels up to the size of their parent's voxels.
/// @throws Error (Fault::usage) when n, m or the resolution cannot work; says which values can.
[[nodiscard]] TreeShape make_tree_shape(int n, int m, int max_resolution, bool with_mips = false);

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
[[nodiscard]] inline Tile parent_of(const Tile& tile, int n) {
    return {tile.level - 1, tile.position / std::int64_t(n)};
}

}  // namespace cairn::renderer
