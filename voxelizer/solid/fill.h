#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"
#include "voxelizer/grid.h"
#include "voxelizer/solid/row_crossings.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// What counts as the inside of a surface.
enum class SolidRule : std::uint8_t {
    winding,  ///< what the surface winds around, in either direction
    parity,   ///< what the surface is crossed an odd number of times to come out of; faces may be turned
    outside,  ///< what the outside cannot reach; faces may also be doubled
};

struct SolidOptions {
    SolidRule rule = SolidRule::winding;
    /// What crossings may take, and what the flood from outside may take.
    std::size_t memory_bytes = std::size_t(1) << 30;
    /// Whether a fill by crossings looks for doubtful voxels, too (SolidTiles::doubts()).
    bool doubts = true;
};

/// The inside of closed meshes by counting crossings, exactly: the voxels whose centre the surface winds
/// around. A solid is these bits together with the surface's own. Runs on the CPU, on all cores.
///
/// A row of voxels along x crosses the surface a number of times; the signs of the crossings up to a centre
/// add up to its winding number, and inside is where it is not 0. So overlapping shells give their union, a
/// shell within another of the same orientation stays solid, one of the opposite orientation is a cavity, and
/// it does not matter whether a whole shell is inside out. Lines, points, and triangles that an alpha mask
/// cuts take no part.
///
/// A mesh is closed when each edge is used as often in one direction as in the other. Then rows along any
/// axis say the same. Else rows along all three axes vote. One whose signs do not add up to 0 is *doubtful*:
/// it runs through a hole, across an open sheet, or across faces that are turned against their neighbours.
/// A voxel is inside only
///   - where two of the rows through it are not doubtful and wind around it, or
///   - where all three say inside, those in doubt by parity: an even number of crossings in all, an odd
///     number before the voxel.
/// So an open sheet fills nothing, nor do two that face each other, and a hole does not leak across the grid:
/// at most what lies straight before it, along two axes, stays empty. A box without a lid is filled. Faces
/// that are turned around in part of a closed mesh are mended where rows along other axes avoid them, or by
/// parity; where rows come out whole by chance, because as many faces are turned one way as the other, gaps
/// between parts may be filled.
///
/// SolidRule::parity looks at the number of crossings alone: inside is where it is odd. A shell within
/// another is a cavity, and so is the overlap of two, whichever way they are turned. A mesh is closed when
/// each edge is used an even number of times; a row is doubtful when it is crossed an odd number of times.
///
/// Build the surface with SurfaceOptions::outside. Without it, a grid that cuts through the scene
/// (grid_over()) has rows that count as doubtful only because a crossing outside the grid is unknown.
class SolidFill {
public:
    /// Crossings take 4 bytes per row, and 4 per crossing of the rows that are crossed an even number of
    /// times.
    /// @param whole    the region that all tiles lie in
    /// @param options  any rule but SolidRule::outside, which is that of Outside
    /// @throws Error (Fault::memory)  if the crossings take more than they may; the message says what fits.
    /// @throws Error (Fault::usage)   if the rule is SolidRule::outside.
    SolidFill(const Surface& surface, const Region& whole, const SolidOptions& options = {});

    /// Sets the bits of voxels that are inside.
    /// @param tile_origin  voxel of the root cube, as Region::origin; the tile lies within `whole`
    /// @throws Error (Fault::usage) if the tile does not lie within `whole`.
    void add_interior(const glm::ivec3& tile_origin, BitGrid& tile) const;

    /// Whether one voxel is inside.
    /// @param voxel  voxel of the root cube, in `whole`
    [[nodiscard]] bool is_inside(const glm::ivec3& voxel) const;

    /// How often the surface winds around a voxel's centre, by the row along x. Nothing if the signs of that
    /// row do not add up to 0.
    /// @param voxel  as for is_inside()
    [[nodiscard]] std::optional<int> winding_at(const glm::ivec3& voxel) const;

    /// Whether the mesh is closed, as the rule means it. Decided by a sum of 128-bit hashes over its edges.
    [[nodiscard]] bool closed() const { return !along_y_; }
    /// Doubtful rows along all three axes, out of row_count() rows.
    [[nodiscard]] std::uint64_t doubtful_rows() const { return doubtful_rows_; }
    [[nodiscard]] std::uint64_t row_count() const;
    [[nodiscard]] std::size_t size_bytes() const;

private:
    /// @param low  the tile's low corner, in voxels from the region's low corner
    void fill_slice(const glm::ivec3& low, int z, BitGrid& tile) const;
    void vote_on_slice(const glm::ivec3& low, int z, BitGrid& tile) const;

    Region whole_;
    SolidRule rule_;
    RowCrossings along_x_;
    std::optional<RowCrossings> along_y_, along_z_;  ///< only if the mesh is not closed
    std::uint64_t doubtful_rows_ = 0;
};

}  // namespace cairn::voxelizer
