#include "voxelizer/solid/solid_tiles.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "voxelizer/solid/cavities.h"
#include "voxelizer/solid/voxel_runs.h"

namespace cairn::voxelizer {
namespace {

bool reaches_beyond(const Surface& surface, const Region& region) {
    if (!surface.outside_triangles.empty() || !surface.far_triangles.empty()) return true;
    const glm::i64vec3 low = glm::i64vec3(region.origin) * std::int64_t(region.voxel_side());
    const glm::i64vec3 high = low + glm::i64vec3(region.size) * std::int64_t(region.voxel_side());
    return std::ranges::any_of(surface.chunks, [&](const SurfaceChunk& chunk) {
        return std::ranges::any_of(chunk.positions, [&](const std::array<std::int32_t, 3>& p) {
            const glm::i64vec3 position(p[0], p[1], p[2]);
            return glm::any(glm::lessThan(position, low)) || glm::any(glm::greaterThan(position, high));
        });
    });
}

/// Closes the sides of a region where its outermost voxels are inside.
void close_inside(const SolidFill& crossings, const Region& region, Outside::Sides& sides) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            Region layer = region;
            layer.size[axis] = 1;
            if (high) layer.origin[axis] += region.size[axis] - 1;
            BitGrid inside(layer.size);
            crossings.add_interior(layer.origin, inside);
            BitGrid& side = sides[std::size_t(axis)][high ? 1 : 0];
            if (axis != 0) {
                side.words = inside.words;  // the axis of size 1 is not in the order of words
                continue;
            }
            for (int z = 0; z < layer.size.z; ++z) {
                for (int y = 0; y < layer.size.y; ++y) {
                    if (inside.at({0, y, z})) side.set({y, z, 0});
                }
            }
        }
    }
}

}  // namespace

SolidTiles::SolidTiles(const Surface& surface, const Grid& grid, const SolidOptions& options, int tile_side)
    : resolution_(grid.resolution),
      counts_(tile_counts(grid, tile_side)),
      side_(tile_side),
      memory_bytes_(options.memory_bytes) {
    const Region region = whole(grid);
    const bool by_crossings = options.rule != SolidRule::outside;
    if (by_crossings) crossings_.emplace(surface, region, options);
    if (by_crossings && !options.doubts) return;
    if (Outside::least_bytes(region) > memory_bytes_) {
        if (!by_crossings) refuse();
        return;
    }
    outside_.emplace(region, memory_bytes_);
    sides_ = Outside::open_sides(region);
    if (!reaches_beyond(surface, region)) return;
    if (by_crossings)
        close_inside(*crossings_, region, sides_);
    else
        close_inside(SolidFill(surface, region, {.memory_bytes = memory_bytes_}), region, sides_);
}

void SolidTiles::refuse() const {
    throw Error(
        Fault::memory, "solid fill",
        fmt::format("what the outside reaches of {} x {} x {} voxels takes more than the {} MiB allowed",
                    resolution_.x, resolution_.y, resolution_.z, memory_bytes_ >> 20),
        "choose fewer voxels, or to fill by winding");
}

std::int64_t SolidTiles::number_of(const VoxelTile& tile) const {
    const glm::ivec3 place = tile.origin / side_;
    return (std::int64_t(place.x) * counts_.z + place.z) * counts_.y + place.y;
}

glm::ivec3 SolidTiles::origin_of(std::int64_t number) const {
    return glm::ivec3(number / (std::int64_t(counts_.y) * counts_.z), number % counts_.y,
                      number / counts_.y % counts_.z) *
           side_;
}

glm::ivec3 SolidTiles::size_of(const glm::ivec3& tile_origin) const {
    return glm::min(glm::ivec3(side_), resolution_ - tile_origin);
}

void SolidTiles::add(VoxelTile&& tile, const TileSink& sink) {
    if (outside_) {
        if (outside_->add_surface(tile.origin, tile.bits)) return;
        if (!crossings_) refuse();
        skip_to(number_of(tile), sink);
        outside_.reset();
    }
    skip_to(number_of(tile), sink);
    ++next_;
    crossings_->add_interior(tile.origin, tile.bits);
    pass_on(std::move(tile), sink);
}

void SolidTiles::finish(const TileSink& sink, const TileSink& doubtful) {
    if (!outside_) {
        skip_to(tile_count(), sink);
        return;
    }
    outside_->flood(std::move(sides_));
    Doubts found;
    Cavities cavities;
    VoxelRuns reached;
    std::vector<std::int64_t> to_look_at;
    bool fits = true;
    for (; next_ < tile_count(); ++next_) {
        const glm::ivec3 origin = origin_of(next_);
        const bool is_reached = (outside_->word_at(origin).reached & 1U) != 0;
        if (is_reached && is_plainly_empty(origin)) continue;
        VoxelTile tile = filled(origin);
        if (crossings_ && fits) {
            const Disagreement disagreement = compared(tile);
            const std::uint64_t open = disagreement.reached.count();
            found.reached += open;
            cavities.add(origin, disagreement.enclosed);
            if (doubtful) reached.add(origin, disagreement.reached);
            if (open > 0 || disagreement.enclosed.count() > 0) to_look_at.push_back(next_);
            fits = cavities.size_bytes() + reached.size_bytes() <= memory_bytes_;
        }
        pass_on(std::move(tile), sink);
    }
    if (!fits) return;
    if (crossings_) cavities.judge(*crossings_, *outside_);
    found.enclosed = cavities.doubtful_voxels();
    doubts_ = found;
    if (!doubtful) return;
    reached.sort();
    for (const std::int64_t number : to_look_at) {
        const glm::ivec3 origin = origin_of(number);
        VoxelTile tile{origin, BitGrid(size_of(origin)), {}};
        cavities.copy_doubtful(origin, tile.bits);
        reached.copy_to(origin, tile.bits, [](std::size_t) { return true; });
        if (tile.bits.count() > 0) doubtful(std::move(tile));
    }
}

bool SolidTiles::is_plainly_empty(const glm::ivec3& tile_origin) const {
    if (outside_ && outside_->has_surface(tile_origin, size_of(tile_origin))) return false;
    return !crossings_ || (crossings_->closed() && !crossings_->is_inside(tile_origin));
}

VoxelTile SolidTiles::filled(const glm::ivec3& tile_origin) const {
    VoxelTile tile{tile_origin, BitGrid(size_of(tile_origin)), {}};
    if (!crossings_) {
        tile.bits = outside_->solid(tile_origin, tile.bits.size);
        return tile;
    }
    if (outside_) tile.bits = outside_->surface(tile_origin, tile.bits.size);
    crossings_->add_interior(tile_origin, tile.bits);
    return tile;
}

SolidTiles::Disagreement SolidTiles::compared(const VoxelTile& tile) const {
    Disagreement out{BitGrid(tile.bits.size), BitGrid(tile.bits.size)};
    tbb::parallel_for(0, tile.bits.size.z, [&](int z) {
        for (int y = 0; y < tile.bits.size.y; ++y) {
            for (int x = 0; x < tile.bits.size.x; x += 32) {
                const std::size_t i = tile.bits.word_index(x, y, z);
                const Outside::Word outside = outside_->word_at(tile.origin + glm::ivec3(x, y, z));
                out.enclosed.words[i] = outside.enclosed & ~tile.bits.words[i];
                out.reached.words[i] = outside.reached & tile.bits.words[i];
            }
        }
    });
    return out;
}

void SolidTiles::pass_on(VoxelTile&& tile, const TileSink& sink) {
    const std::uint64_t occupied = tile.bits.count();
    if (occupied == 0) return;
    occupied_ += occupied;
    sink(std::move(tile));
}

void SolidTiles::skip_to(std::int64_t number, const TileSink& sink) {
    for (; next_ < number; ++next_) {
        const glm::ivec3 origin = origin_of(next_);
        if (!is_plainly_empty(origin)) pass_on(filled(origin), sink);
    }
}

}  // namespace cairn::voxelizer
