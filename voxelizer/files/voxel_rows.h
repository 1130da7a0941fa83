#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "voxelizer/files/voxel_writer.h"

namespace cairn::voxelizer {

/// Turns tiles, whose rows of bits run along x, into rows along y or z, for formats whose x runs slowest.
///
/// Memory, for one slab of tiles along x: 128 bytes per 32 x 32 voxels of a slice that are not empty, and 4
/// KiB per tile that holds voxels.
class VoxelRows {
public:
    /// @param row_axis  1: rows run along y, 2: along z. The other of the two axes runs second.
    VoxelRows(const glm::ivec3& grid_size, int row_axis)
        : size_(grid_size), row_axis_(row_axis), words_(std::size_t(grid_size[row_axis] + 31) / 32) {}

    /// Takes a tile. If it begins a new slab, the rows of the slabs before go to the sink first.
    /// @param sink  as in finish()
    template <typename Sink>
    void add(const VoxelTile& tile, Sink& sink) {
        write_slabs(tile.origin.x, sink);
        gather(tile);
    }

    /// Gives the remaining rows to the sink. All rows come in order, x slowest, by calls of
    /// sink.row(std::span<const std::uint32_t>), with 32 voxels per word, or sink.empty_rows(std::uint64_t
    /// count).
    template <typename Sink>
    void finish(Sink& sink) {
        write_slabs(size_.x, sink);
    }

private:
    /// Word i holds voxels 0 to 31 of the row at x = i.
    using Block = std::array<std::uint32_t, 32>;
    static constexpr std::size_t blocks_per_side = VOXEL_TILE_SIDE / 32;
    static constexpr std::uint16_t no_block = 0xFFFF;
    struct TurnedTile {
        std::size_t first_word = 0;  ///< the tile's low end along the row, in words
        int slice = 0;               ///< the tile's low end along the second axis, in voxels
        /// Index into `blocks` per block (x block, slice, row block); no_block: the block is empty.
        std::vector<std::uint16_t> numbers;
        std::vector<Block> blocks;
    };

    void gather(const VoxelTile& tile);
    /// Sorts the slab's tiles by slice. @return one past the slab's last x.
    int begin_slab();
    /// Fills `words_`. @return whether any bit is set.
    bool fill_row(std::span<const TurnedTile> tiles, int x, int slice);

    template <typename Sink>
    void write_slabs(int until, Sink& sink) {
        while (slab_ < until) {
            const int end = begin_slab();
            for (int x = 0; x < end - slab_; ++x)
                write_plane(x, sink);
            tiles_.clear();
            slab_ = end;
        }
    }

    template <typename Sink>
    void write_plane(int x, Sink& sink) {
        const int slices = size_[3 - row_axis_];
        auto tile = tiles_.cbegin();
        for (int low = 0; low < slices; low += VOXEL_TILE_SIDE) {
            const int count = slices - low < VOXEL_TILE_SIDE ? slices - low : VOXEL_TILE_SIDE;
            const auto first = tile;
            while (tile != tiles_.cend() && tile->slice == low)
                ++tile;
            if (first == tile) {
                sink.empty_rows(std::uint64_t(count));
                continue;
            }
            for (int slice = 0; slice < count; ++slice) {
                if (fill_row({first, tile}, x, slice))
                    sink.row(std::span<const std::uint32_t>(words_));
                else
                    sink.empty_rows(std::uint64_t(1));
            }
        }
    }

    glm::ivec3 size_;
    int row_axis_;
    int slab_ = 0;  ///< low x of the slab whose tiles are gathered
    std::vector<TurnedTile> tiles_;
    std::vector<std::uint32_t> words_;
};

}  // namespace cairn::voxelizer
