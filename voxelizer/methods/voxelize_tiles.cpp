#include "voxelizer/methods/voxelize_tiles.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/voxelize.h"
#include "voxelizer/files/voxel_tiles.h"
#include "voxelizer/methods/pyramid_builder.h"

namespace cairn::voxelizer {
namespace {

/// Empty tiles that a region may take in so that there is one region fewer: a region costs about as much as
/// clearing and reading so many tiles.
constexpr int spare_tiles = 8;

/// Tiles of one slab, from `first` up to but without `end`: x is z, y is y.
struct TileRange {
    glm::ivec2 first{0};
    glm::ivec2 end{0};

    [[nodiscard]] std::int64_t count() const {
        return std::int64_t(end.x - first.x) * std::int64_t(end.y - first.y);
    }
    [[nodiscard]] bool empty() const { return count() == 0; }
    [[nodiscard]] TileRange with(const TileRange& other) const {
        return {glm::min(first, other.first), glm::max(end, other.end)};
    }
};

class TileWalk {
public:
    TileWalk(Voxelizer& voxelizer, const GpuSurface& surface, TriangleIndex& index, const Grid& grid,
             const TileSink& sink, const TileProgress& progress, const TileOptions& options)
        : voxelizer_(voxelizer),
          surface_(surface),
          index_(index),
          resolution_(grid.resolution),
          level_(grid.level()),
          counts_(tile_counts(grid, options.tile_side)),
          sink_(sink),
          progress_(progress),
          options_(options) {}

    TileStatistics run() {
        if (bit_bytes(resolution_) <= options_.whole_bytes &&
            glm::all(glm::lessThanEqual(resolution_, glm::ivec3(VOXEL_REGION_SIDE)))) {
            report(0.0);
            mark({level_, glm::ivec3(0), resolution_}, std::nullopt);
            return statistics_;
        }
        for (int slab = 0; slab < counts_.x; ++slab) {
            report(slab, 0);
            walk_slab(slab);
        }
        return statistics_;
    }

private:
    [[nodiscard]] int side() const { return options_.tile_side; }
    /// The voxels of some tiles of a slab.
    [[nodiscard]] Region region_of(int slab, const TileRange& range) const {
        const glm::ivec3 low = side() * glm::ivec3(slab, range.first.y, range.first.x);
        const glm::ivec3 high =
            glm::min(side() * glm::ivec3(slab + 1, range.end.y, range.end.x), resolution_);
        return {level_, low, high - low};
    }
    [[nodiscard]] bool fits(int slab, const TileRange& range) const {
        const Region region = region_of(slab, range);
        return range.count() == 1 ||
               (bit_bytes(region.size) <= options_.region_bytes &&
                glm::all(glm::lessThanEqual(region.size, glm::ivec3(VOXEL_REGION_SIDE))));
    }

    /// The rows of a slab (tiles of one z), each from its first to its last tile that a triangle may meet.
    [[nodiscard]] std::vector<TileRange> rows_of_slab(int slab);
    void add_to_rows(const glm::i64vec3& low, const glm::i64vec3& high, std::vector<TileRange>& rows) const;
    void walk_slab(int slab);
    void mark_range(int slab, const TileRange& range);
    void mark(const Region& region, std::optional<std::span<const std::uint32_t>> subset);
    void emit(const Region& region, const BitGrid& bits);

    void report(double share) const {
        if (!progress_ || progress_(share)) return;
        throw Error(Fault::interrupted, "", "interrupted; nothing was left half written");
    }
    void report(int slab, int row) const { report((slab + double(row) / counts_.z) / counts_.x); }

    Voxelizer& voxelizer_;
    const GpuSurface& surface_;
    TriangleIndex& index_;
    glm::ivec3 resolution_;
    int level_;
    glm::ivec3 counts_;
    const TileSink& sink_;
    const TileProgress& progress_;
    TileOptions options_;
    TileStatistics statistics_;
};

void TileWalk::add_to_rows(const glm::i64vec3& low, const glm::i64vec3& high,
                           std::vector<TileRange>& rows) const {
    // Closed tiles that meet the closed box.
    const std::int64_t unit = std::int64_t(side()) << (LATTICE_BITS - level_);
    const auto first_of = [&](std::int64_t at) {
        return int((std::max<std::int64_t>(at, 0) + unit - 1) / unit) - 1;
    };
    const auto last_of = [&](std::int64_t at, int count) {
        return int(std::min<std::int64_t>(at / unit, count - 1));
    };
    const int y_first = std::max(first_of(low.y), 0);
    const int y_last = last_of(high.y, counts_.y);
    for (int z = std::max(first_of(low.z), 0); z <= last_of(high.z, counts_.z); ++z) {
        const TileRange tiles{{z, y_first}, {z + 1, y_last + 1}};
        TileRange& row = rows[std::size_t(z)];
        if (y_first <= y_last) row = row.empty() ? tiles : row.with(tiles);
    }
}

std::vector<TileRange> TileWalk::rows_of_slab(int slab) {
    std::vector<TileRange> rows(std::size_t(counts_.z));
    const Region whole_slab = region_of(slab, {glm::ivec2(0), {counts_.z, counts_.y}});
    for (const std::uint32_t triangle : index_.triangles_in(whole_slab)) {
        const TriangleIndex::Box& box = index_.box(triangle);
        add_to_rows(glm::i64vec3(box.low), glm::i64vec3(box.high), rows);
    }
    const std::int64_t unit = whole_slab.voxel_side();
    for (const TriangleIndex::FarBox& box : index_.far_boxes()) {
        const std::int64_t low = whole_slab.origin.x * unit;
        if (box.low.x <= low + whole_slab.size.x * unit && box.high.x >= low)
            add_to_rows(box.low, box.high, rows);
    }
    return rows;
}

/// Rows are joined in one region while they fit, and while that takes in few tiles that none of them asks
/// for.
void TileWalk::walk_slab(int slab) {
    TileRange joined;
    std::int64_t asked_for = 0;
    for (const TileRange& row : rows_of_slab(slab)) {
        if (row.empty()) continue;
        const TileRange more = joined.empty() ? row : joined.with(row);
        if (joined.empty() || (fits(slab, more) && more.count() <= asked_for + row.count() + spare_tiles)) {
            joined = more;
            asked_for += row.count();
            continue;
        }
        mark_range(slab, joined);
        joined = row;
        asked_for = row.count();
    }
    if (!joined.empty()) mark_range(slab, joined);
}

void TileWalk::mark_range(int slab, const TileRange& range) {
    report(slab, range.first.x);
    if (!fits(slab, range)) {  // then it is a single row: cut it along y
        const int middle = (range.first.y + range.end.y) / 2;
        mark_range(slab, {range.first, {range.end.x, middle}});
        mark_range(slab, {{range.first.x, middle}, range.end});
        return;
    }
    const Region region = region_of(slab, range);
    const std::vector<std::uint32_t> triangles = index_.triangles_in(region);
    if (triangles.empty() && index_.far_boxes().empty()) return;
    if (triangles.size() == index_.triangle_count())
        mark(region, std::nullopt);
    else
        mark(region, triangles);
}

void TileWalk::mark(const Region& region, std::optional<std::span<const std::uint32_t>> subset) {
    if (options_.warm_up && statistics_.regions == 0) (void)voxelizer_.voxelize(surface_, region, subset);
    const BitGrid bits = voxelizer_.voxelize(surface_, region, subset);
    statistics_.milliseconds += voxelizer_.last_milliseconds();
    statistics_.triangles += subset ? subset->size() : index_.triangle_count();
    ++statistics_.regions;
    emit(region, bits);
}

void TileWalk::emit(const Region& region, const BitGrid& bits) {
    for (int x = 0; x < region.size.x; x += side()) {
        for (int z = 0; z < region.size.z; z += side()) {
            for (int y = 0; y < region.size.y; y += side()) {
                VoxelTile tile{region.origin + glm::ivec3(x, y, z), tile_bits(bits, {x, y, z}, side()), {}};
                const std::uint64_t occupied = tile.bits.count();
                if (occupied == 0) continue;
                statistics_.occupied += occupied;
                ++statistics_.tiles;
                sink_(std::move(tile));
            }
        }
    }
}

}  // namespace

TileStatistics voxelize_tiles(Voxelizer& voxelizer, const GpuSurface& surface, TriangleIndex& index,
                              const Grid& grid, const TileSink& sink, const TileProgress& progress,
                              const TileOptions& options) {
    if (options.tile_side < 32 || options.tile_side % 32 != 0) {
        throw Error(Fault::usage, "tiles",
                    fmt::format("a side of {} is no multiple of 32", options.tile_side));
    }
    return TileWalk(voxelizer, surface, index, grid, sink, progress, options).run();
}

}  // namespace cairn::voxelizer
