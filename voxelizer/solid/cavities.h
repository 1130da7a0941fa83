#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/solid/fill.h"
#include "voxelizer/solid/outside.h"
#include "voxelizer/solid/voxel_runs.h"

namespace cairn::voxelizer {

/// The empty voxels that a surface encloses, in parts that are joined by faces, and which of these parts may
/// not be meant as cavities.
///
/// From each voxel at the border of a part, along all three axes, it is asked what lies behind the wall: the
/// first voxel that the surface winds around, at most four voxels away and before one that the surface does
/// not touch. A part is doubtful
///   - if there are winding numbers of both signs behind its walls: parts that are turned against each other
///     overlap;
///   - if there is nothing behind most of its walls: faces are doubled, or missing, or a mask cuts them, or
///     walls are thinner than a voxel;
///   - by SolidRule::parity, if its own winding number is not 0: it lies in two parts of the surface.
class Cavities {
public:
    /// Takes the empty, enclosed voxels of one tile.
    void add(const glm::ivec3& tile_origin, const BitGrid& tile) { runs_.add(tile_origin, tile); }
    /// What judge() takes, too.
    [[nodiscard]] std::size_t size_bytes() const;

    /// Finds the doubtful parts; after the last add().
    void judge(const SolidFill& crossings, const Outside& outside);
    [[nodiscard]] std::uint64_t doubtful_voxels() const;
    /// Sets the bits of a tile's doubtful voxels.
    void copy_doubtful(const glm::ivec3& tile_origin, BitGrid& tile) const;

private:
    [[nodiscard]] std::uint32_t part_of(std::uint32_t run);
    void join(std::uint32_t a, std::uint32_t b);
    void join_with_row(std::uint32_t run, int y, int z);

    VoxelRuns runs_;
    std::vector<std::uint32_t>
        parents_;                    ///< by run: another run of the same part, itself if it stands for it
    std::vector<bool> is_doubtful_;  ///< by run
};

}  // namespace cairn::voxelizer
