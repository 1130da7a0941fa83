#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "voxelizer/bit_grid.h"

namespace cairn::voxelizer {

/// Voxels that lie side by side along x.
struct VoxelRun {
    glm::ivec3 first{0};
    int length = 0;

    [[nodiscard]] int end() const { return first.x + length; }
};

/// A set of voxels as runs: it takes memory in proportion to its surface.
class VoxelRuns {
public:
    /// Adds the voxels of one tile. Tiles may come in any order, each once.
    void add(const glm::ivec3& tile_origin, const BitGrid& tile);
    /// Sorts the runs by z, y and x, and joins those that tiles have cut. After the last add().
    void sort();

    [[nodiscard]] std::span<const VoxelRun> all() const { return runs_; }
    /// The runs of one row, after sort().
    [[nodiscard]] std::span<const VoxelRun> row(int y, int z) const;
    [[nodiscard]] std::size_t size_bytes() const { return runs_.size() * sizeof(VoxelRun); }

    /// Sets the bits of those runs, after sort(), whose number in all() is wanted.
    template <typename Wanted>
    void copy_to(const glm::ivec3& tile_origin, BitGrid& tile, const Wanted& wanted) const {
        for (int z = 0; z < tile.size.z; ++z) {
            for (int y = 0; y < tile.size.y; ++y) {
                for (const VoxelRun& run : row(tile_origin.y + y, tile_origin.z + z)) {
                    if (wanted(std::size_t(&run - runs_.data())))
                        copy_run(run, tile_origin, glm::ivec3(0, y, z), tile);
                }
            }
        }
    }

private:
    static void copy_run(const VoxelRun& run, const glm::ivec3& tile_origin, const glm::ivec3& row,
                         BitGrid& tile);

    std::vector<VoxelRun> runs_;
};

}  // namespace cairn::voxelizer
