#pragma once

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
    /// Empty, though the surface encloses them, and SolidFill::is_doubtful_cavity(): faces that are doubled
    /// or turned, or parts that are turned against each other.
    std::uint64_t enclosed = 0;
    /// Filled, though the outside reaches them: what is around them has a hole.
    std::uint64_t reached = 0;
};

/// Takes the tiles of voxelize_tiles(), adds the inside of closed meshes to each, and passes them on in the
/// order of VoxelWriter, those included of which only the inside is occupied.
class SolidTiles {
public:
    /// @param surface  built with SurfaceOptions::outside; it is not needed later
    /// @throws Error (Fault::memory) as SolidFill
    SolidTiles(const Surface& surface, const Grid& grid, const SolidOptions& options = {},
               int tile_side = VOXEL_TILE_SIDE);

    /// Takes the next tile. By SolidRule::outside, tiles are passed on only in finish().
    /// @throws Error (Fault::memory) if the flood of SolidRule::outside would take more than it may.
    void add(VoxelTile&& tile, const TileSink& sink);
    /// Passes on the remaining tiles; to be called after the last add().
    void finish(const TileSink& sink);

    /// The doubtful voxels, after finish(); tiles that hold them go to `sink`. By SolidRule::outside there
    /// are none. Nothing if the flood would take more memory than it may.
    [[nodiscard]] std::optional<Doubts> find_doubts(const TileSink& sink = {}) const;

    /// None by SolidRule::outside.
    [[nodiscard]] const std::optional<SolidFill>& crossings() const { return crossings_; }
    /// Occupied voxels passed on so far.
    [[nodiscard]] std::uint64_t occupied() const { return occupied_; }

private:
    [[nodiscard]] VoxelTile empty_tile(std::int64_t number) const;
    [[nodiscard]] std::int64_t number_of(const VoxelTile& tile) const;
    [[nodiscard]] std::int64_t tile_count() const { return std::int64_t(counts_.x) * counts_.y * counts_.z; }
    /// Passes on the tiles before that number of which only the inside is occupied.
    void skip_to(std::int64_t number, const TileSink& sink);
    void emit(VoxelTile&& tile, const TileSink& sink);

    glm::ivec3 resolution_;
    glm::ivec3 counts_;
    int side_;
    std::size_t memory_bytes_;
    std::optional<SolidFill> crossings_;
    std::optional<Outside> outside_;  ///< none once it would have taken too much
    std::int64_t next_ = 0;           ///< number of the next tile, in the order of VoxelWriter
    std::uint64_t occupied_ = 0;
};

}  // namespace cairn::voxelizer
