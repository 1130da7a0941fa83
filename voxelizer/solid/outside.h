#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// What the outside of a surface reaches: voxels that the surface does not touch, joined by their faces. The
/// rest is enclosed, whichever way its faces are turned and however often they are doubled. As a conservative
/// voxelization has no gaps, the outside enters through a hole only where a whole voxel of the hole is free
/// of the surface.
///
/// The outside comes in over the sides of the region, straight along an axis, wherever no triangle lies
/// before that place. So a region that cuts through a closed mesh is not open at the cut. Lines, points and
/// triangles that an alpha mask cuts stop the outside by their voxels, but not beyond the region.
///
/// A flood over blocks of 32^3 voxels on the CPU, on all cores. A block that the surface touches takes 8 KiB,
/// any other 9 bytes.
class Outside {
public:
    static constexpr int block_side = 32;

    /// @param surface       built with SurfaceOptions::outside; it is not needed later
    /// @param whole         the region that all tiles lie in
    /// @param memory_bytes  what the blocks may take
    Outside(const Surface& surface, const Region& whole, std::size_t memory_bytes);

    /// Takes the voxels that the surface touches, of one tile. Tiles without any may be left out.
    /// @param tile_origin  voxel of the root cube; its distance from the region's origin is a multiple of
    ///                     block_side. The tile lies within the region.
    /// @return false if the blocks would take more memory than they may
    [[nodiscard]] bool add_surface(const glm::ivec3& tile_origin, const BitGrid& tile);

    /// Lets the outside in; after the last add_surface().
    void flood();

    /// Of a tile's voxels that the surface does not touch, those that the outside reaches; after flood().
    [[nodiscard]] BitGrid reached(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;
    /// And those that it does not reach.
    [[nodiscard]] BitGrid enclosed(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;
    /// Those that it does not reach, together with the surface's own.
    [[nodiscard]] BitGrid solid(const glm::ivec3& tile_origin, const glm::ivec3& tile_size) const;

    [[nodiscard]] std::size_t size_bytes() const;

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

    void find_covered(const Surface& surface, int axis);
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
    template <typename Row>
    [[nodiscard]] BitGrid copied(const glm::ivec3& tile_origin, const glm::ivec3& tile_size,
                                 const Row& row) const;

    Region whole_;
    glm::ivec3 counts_;
    std::size_t memory_bytes_;
    std::size_t stored_ = 0;
    std::vector<std::unique_ptr<Block>> blocks_;  ///< null if the surface does not touch the block
    std::vector<std::uint8_t> wholly_reached_;    ///< of blocks that the surface does not touch
    /// By axis, low and high: the places of that side of the region before which a triangle lies. Sides along
    /// x have the axes y, z, those along y x, z, those along z x, y.
    std::array<std::array<BitGrid, 2>, 3> covered_;
};

}  // namespace cairn::voxelizer
