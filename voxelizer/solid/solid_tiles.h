#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

#include "voxelizer/files/voxel_writer.h"
#include "voxelizer/grid.h"
#include "voxelizer/methods/voxelize_tiles.h"
#include "voxelizer/solid/fill.h"
#include "voxelizer/solid/outside.h"

namespace cairn::voxelizer {

/// Voxels of a solid on which crossings and the flood from outside do not agree.
struct Doubts {
    /// Empty, though the surface encloses them, and not between walls that make a cavity (Cavities).
    std::uint64_t enclosed = 0;
    /// Filled, though the outside reaches them: what is around them has a hole.
    std::uint64_t reached = 0;
};

/// Takes the tiles of voxelize_tiles(), adds the inside of closed meshes to each, and passes them on in the
/// order of VoxelWriter, those included of which only the inside is occupied.
///
/// The surface's voxels are kept until the last of them is there, for the flood (Outside). Where a grid cuts
/// through a scene, the outside comes in over the grid's sides wherever crossings say that nothing is inside;
/// by SolidRule::outside, crossings by winding.
///
/// If the flood takes more memory than it may, a fill by crossings goes on without it, tile by tile, and
/// looks for no doubts.
class SolidTiles {
public:
    /// @param surface  built with SurfaceOptions::outside; it is not needed later
    /// @throws Error (Fault::memory) as SolidFill, and as add()
    SolidTiles(const Surface& surface, const Grid& grid, const SolidOptions& options = {},
               int tile_side = VOXEL_TILE_SIDE);

    /// Takes the next tile. Its voxels must be those of a conservative method, unless a fill by crossings
    /// looks for no doubts.
    /// @throws Error (Fault::memory) if the flood of SolidRule::outside would take more than it may.
    void add(VoxelTile&& tile, const TileSink& sink);
    /// Passes on the remaining tiles, all of them as a rule; to be called after the last add().
    /// @param doubtful  takes the doubtful voxels, in tiles in the same order
    void finish(const TileSink& sink, const TileSink& doubtful = {});

    /// After finish(): the number of doubtful voxels, of which SolidRule::outside has none. Nothing if they
    /// were not looked for.
    [[nodiscard]] const std::optional<Doubts>& doubts() const { return doubts_; }
    /// Whether doubts() will be there, as far as it is known.
    [[nodiscard]] bool looks_for_doubts() const { return outside_.has_value(); }
    /// None by SolidRule::outside.
    [[nodiscard]] const std::optional<SolidFill>& crossings() const { return crossings_; }
    /// Occupied voxels passed on so far.
    [[nodiscard]] std::uint64_t occupied() const { return occupied_; }

private:
    [[nodiscard]] std::int64_t tile_count() const { return std::int64_t(counts_.x) * counts_.y * counts_.z; }
    [[nodiscard]] std::int64_t number_of(const VoxelTile& tile) const;
    [[nodiscard]] glm::ivec3 origin_of(std::int64_t number) const;
    [[nodiscard]] glm::ivec3 size_of(const glm::ivec3& tile_origin) const;

    /// Whether nothing is inside in a tile that the surface does not touch, seen from one of its voxels: a
    /// closed mesh does not divide what it does not touch.
    [[nodiscard]] bool is_plainly_empty(const glm::ivec3& tile_origin) const;
    [[noreturn]] void refuse() const;
    [[nodiscard]] VoxelTile filled(const glm::ivec3& tile_origin) const;
    /// Where crossings and the flood do not agree on a filled tile.
    struct Disagreement {
        BitGrid enclosed, reached;
    };
    [[nodiscard]] Disagreement compared(const VoxelTile& tile) const;
    void pass_on(VoxelTile&& tile, const TileSink& sink);
    /// Passes on the tiles before that number.
    void skip_to(std::int64_t number, const TileSink& sink);

    glm::ivec3 resolution_;
    glm::ivec3 counts_;
    int side_;
    std::size_t memory_bytes_;
    std::optional<SolidFill> crossings_;
    std::optional<Outside> outside_;  ///< none once it would have taken too much
    Outside::Sides sides_;
    std::optional<Doubts> doubts_;
    std::int64_t next_ = 0;  ///< number of the next tile to pass on, in the order of VoxelWriter
    std::uint64_t occupied_ = 0;
};

}  // namespace cairn::voxelizer
