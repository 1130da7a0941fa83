#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"

namespace cairn::voxelizer {

/// What the outside of a surface reaches: voxels that the surface does not touch, joined by their faces. The
/// rest is enclosed, whichever way its faces are turned and however often they are doubled. The voxels that
/// the surface touches must be those of a conservative method. These have no gaps, so that the outside enters
/// through a hole only where a whole voxel of the hole is free of the surface.
///
/// A flood over blocks of 32^3 voxels on the CPU, on all cores. A block that the surface touches takes 8 KiB,
/// any other 10 bytes, and each place on a side of the region a bit.
class Outside {
public:
    static constexpr int block_side = 32;

    /// The places on the sides of a region where the outside does not come in: by axis, low and high. Sides
    /// along x have the axes y, z, those along y x, z, those along z x, y; their depth is 1.
    using Sides = std::array<std::array<BitGrid, 2>, 3>;
    /// Sides that are open everywhere.
    [[nodiscard]] static Sides open_sides(const Region& whole);

    /// @param whole         the region that all tiles lie in
    /// @param memory_bytes  what the flood may take, at least least_bytes()
    Outside(const Region& whole, std::size_t memory_bytes);

    /// Takes the voxels that the surface touches, of one tile. Tiles without any may be left out.
    /// @param tile_origin  voxel of the root cube; its distance from the region's origin is a multiple of
    ///                     block_side. The tile lies within the region.
    /// @return false if the blocks would take more memory than they may
    [[nodiscard]] bool add_surface(const glm::ivec3& tile_origin, const BitGrid& tile);

    /// Lets the outside in, wherever the region's sides are open; after the last add_surface().
    /// @param closed  of the sizes that open_sides() has
    void flood(Sides closed);

    /// 32 voxels of a row along x, one bit each. Each voxel is in one of the three.
    struct Word {
        std::uint32_t reached;   ///< not touched by the surface, and reached by the outside
        std::uint32_t enclosed;  ///< not touched by the surface, and not reached
        std::uint32_t surface;   ///< touched by the surface
    };
    /// @param voxel  the first of them, with the lowest bit: voxel of the root cube, in the region; along x
    ///               its distance from the region's origin is a multiple of block_side. Past the region, bits
    ///               are 0.
    [[nodiscard]] Word word_at(const glm::ivec3& voxel) const;

    /// A tile's voxels that the outside does not reach, the surface's own among them; after flood().
    [[nodiscard]] BitGrid solid(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;
    /// The surface's own, as they were added.
    [[nodiscard]] BitGrid surface(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;
    /// Whether a voxel of the root cube lies in the region.
    [[nodiscard]] bool holds(const glm::ivec3& voxel) const;
    /// Whether the surface touches a voxel of the region.
    [[nodiscard]] bool touches(const glm::ivec3& voxel) const;
    /// Whether the surface touches one of the blocks that a tile lies in.
    [[nodiscard]] bool has_surface(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;

    [[nodiscard]] std::size_t size_bytes() const;
    /// What a region takes whose voxels the surface does not touch.
    [[nodiscard]] static std::size_t least_bytes(const Region& whole);

private:
    /// Rows along x, of one word each: row y, z of a block is [z * 32 + y].
    using Rows = std::array<std::uint32_t, std::size_t(block_side) * block_side>;
    struct Block {
        Rows free{};  ///< voxels of the region that the surface does not touch
        Rows reached{};
    };

    [[nodiscard]] std::size_t number_of(const glm::ivec3& place) const;
    [[nodiscard]] glm::ivec3 place_of(std::size_t number) const;
    /// Voxels of a block that lie in the region, along each axis.
    [[nodiscard]] glm::ivec3 size_of(const glm::ivec3& place) const;
    [[nodiscard]] std::unique_ptr<Block> make_block(const glm::ivec3& place) const;

    [[nodiscard]] std::uint32_t row_reached(std::size_t number, int y, int z) const;
    /// Calls visit(y, z, word) for rows of a block with the voxels of it that the outside enters from the
    /// neighbours and over the region's sides. Some of them may be touched by the surface.
    template <typename Visit>
    void visit_entries(std::size_t number, const Visit& visit) const;
    /// Calls visit(number) for the neighbours of a block by a face.
    template <typename Visit>
    void visit_neighbours(std::size_t number, const Visit& visit) const;
    [[nodiscard]] bool is_beside_wholly_reached(std::size_t number) const;
    /// Lets in what the neighbours hold. @return whether the block holds more than before.
    [[nodiscard]] bool advance(std::size_t number);
    template <typename Part>
    [[nodiscard]] BitGrid copied(const glm::ivec3& tile_origin, const glm::ivec3& tile_size,
                                 const Part& part) const;

    Region whole_;
    glm::ivec3 counts_;
    std::size_t memory_bytes_;
    std::size_t stored_ = 0;
    std::vector<std::unique_ptr<Block>> blocks_;  ///< null if the surface does not touch the block
    std::vector<std::uint8_t> wholly_reached_;    ///< of blocks that the surface does not touch
    Sides closed_;
};

}  // namespace cairn::voxelizer
