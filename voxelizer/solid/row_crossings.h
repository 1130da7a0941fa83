#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/grid.h"
#include "voxelizer/surface/surface.h"

namespace cairn::voxelizer {

/// Where the lines through the centres of voxels cross triangles: for each row of a region along one axis,
/// the crossings in order, each with its sign: +1 where the line leaves through the front (the triangle's
/// normal looks along the axis), -1 where it enters.
///
/// Exact, and consistent for any mesh: centres count as moved by (e, e^2, e^3) for an infinitely small e > 0
/// (simulation of simplicity: Edelsbrunner and Mücke 1990), so no line meets an edge or a vertex, each line
/// crosses a closed mesh as often in as out, and all three axes judge the same point. Triangles parallel to
/// the axis, those without area, and those that an alpha mask cuts are not crossed.
class RowCrossings {
public:
    /// @param axis          0, 1, 2: rows along x, y, z
    /// @param memory_bytes  what the crossings may take
    /// @throws Error (Fault::memory) if they would take more; the message says what would fit.
    RowCrossings(const Surface& surface, const Region& region, int axis, std::size_t memory_bytes);

    /// A crossing: the first voxel of the row whose centre lies beyond it, or the row's length.
    struct Event {
        std::uint32_t packed;
        [[nodiscard]] int voxel() const { return int(packed >> 1); }
        [[nodiscard]] int winding() const { return (packed & 1U) != 0 ? -1 : 1; }
    };
    /// The crossings of the row through a voxel of the region (its coordinate along the axis does not
    /// matter), ascending. Empty if the row is odd.
    [[nodiscard]] std::span<const Event> row(const glm::ivec3& voxel) const {
        const std::size_t i = row_number(voxel);
        const std::size_t first = i == 0 ? 0 : ends_[i - 1];
        return {events_.data() + first, ends_[i] - first};
    }
    /// Whether the row is crossed an odd number of times: its signs cannot add up to 0, and nothing can be
    /// said about its voxels. Open meshes have many, so their crossings are not kept.
    [[nodiscard]] bool is_odd(const glm::ivec3& voxel) const { return odd_[row_number(voxel)]; }
    [[nodiscard]] std::size_t size_bytes() const {
        return ends_.size() * sizeof(std::uint32_t) + events_.size() * sizeof(Event) + odd_.size() / 8;
    }

private:
    [[nodiscard]] std::size_t row_number(const glm::ivec3& voxel) const {
        return std::size_t(voxel[v_]) * std::size_t(u_size_) + std::size_t(voxel[u_]);
    }

    int u_, v_;  ///< the other two axes, cyclic
    int u_size_;
    std::vector<std::uint32_t> ends_;  ///< per row, one past its last event in `events_`
    std::vector<Event> events_;
    std::vector<bool> odd_;
};

}  // namespace cairn::voxelizer
