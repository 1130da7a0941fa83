#include "bench/peers/cpu_row_span.h"

#include <algorithm>
#include <vector>

#include <tbb/parallel_for.h>

#include "bench/peers/row_spans.h"
#include "shaders/interop/grid.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/exact_mask.h"
#include "voxelizer/surface/far_triangles.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::bench {
namespace {

using voxelizer::BitGrid;
using voxelizer::Region;
using voxelizer::Surface;
using voxelizer::SurfaceChunk;

/// Bytes that are cleared and filled at a time: they fit the cache of one core.
constexpr std::size_t slab_bytes = std::size_t(256) << 10;
constexpr std::size_t block_triangles = 4096;

std::array<glm::ivec3, 3> corners_of(const SurfaceChunk& chunk, std::size_t triangle) {
    std::array<glm::ivec3, 3> out;
    for (int i = 0; i < 3; ++i) {
        const auto& p = chunk.positions[chunk.triangles[triangle].vertices[i]];
        out[std::size_t(i)] = {p[0], p[1], p[2]};
    }
    return out;
}

void set_bits(std::uint32_t* row, int first, int last) {
    const std::uint32_t head = ~0U << (first & 31);
    const std::uint32_t tail = ~0U >> (31 - (last & 31));
    std::uint32_t* word = row + first / 32;
    std::uint32_t* const end = row + last / 32;
    if (word == end) {
        *word |= head & tail;
        return;
    }
    *word++ |= head;
    while (word != end)
        *word++ = ~0U;
    *end |= tail;
}

/// For each slab, the triangles of a chunk that reach it.
class SlabLists {
public:
    SlabLists(const SurfaceChunk& chunk, const Region& region, int slab_slices)
        : slab_slices_(slab_slices), slab_count_((region.size.z + slab_slices - 1) / slab_slices) {
        const std::size_t blocks = (chunk.triangles.size() + block_triangles - 1) / block_triangles;
        std::vector<Span> reach(chunk.triangles.size());
        std::vector<std::uint32_t> place(blocks * std::size_t(slab_count_));
        const auto for_block = [&](std::size_t block, const auto& visit) {
            const std::size_t last = std::min((block + 1) * block_triangles, chunk.triangles.size());
            for (std::size_t i = block * block_triangles; i < last; ++i)
                visit(i);
        };
        tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
            for_block(block, [&](std::size_t i) {
                reach[i] = slabs_of(corners_of(chunk, i), region);
                for (int slab = reach[i].first; slab <= reach[i].last; ++slab)
                    ++place[block * std::size_t(slab_count_) + std::size_t(slab)];
            });
        });
        first_.assign(std::size_t(slab_count_) + 1, 0);
        std::uint32_t total = 0;
        for (std::size_t slab = 0; slab < std::size_t(slab_count_); ++slab) {
            first_[slab] = total;
            for (std::size_t block = 0; block < blocks; ++block) {
                const std::uint32_t count = place[block * std::size_t(slab_count_) + slab];
                place[block * std::size_t(slab_count_) + slab] = total;
                total += count;
            }
        }
        first_.back() = total;
        triangles_.resize(total);
        tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
            for_block(block, [&](std::size_t i) {
                for (int slab = reach[i].first; slab <= reach[i].last; ++slab)
                    triangles_[place[block * std::size_t(slab_count_) + std::size_t(slab)]++] =
                        std::uint32_t(i);
            });
        });
    }

    [[nodiscard]] std::span<const std::uint32_t> of(int slab) const {
        const auto i = std::size_t(slab);
        return std::span(triangles_).subspan(first_[i], first_[i + 1] - first_[i]);
    }

private:
    [[nodiscard]] Span slabs_of(const std::array<glm::ivec3, 3>& p, const Region& region) const {
        const int shift = LATTICE_BITS - region.level;
        const glm::ivec3 low = low_voxel(p, shift) - region.origin;
        const glm::ivec3 high = high_voxel(p, shift) - region.origin;
        if (glm::any(glm::lessThan(high, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(low, region.size))) {
            return {1, 0};
        }
        return {std::max(low.z, 0) / slab_slices_, std::min(high.z, region.size.z - 1) / slab_slices_};
    }

    int slab_slices_;
    int slab_count_;
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> triangles_;
};

/// Marks voxels in some slices of the region.
class SlabMarker {
public:
    SlabMarker(const Surface& surface, const Region& region, BitGrid& bits, Span slices)
        : surface_(surface), region_(region), bits_(bits), slices_(slices) {}

    void mark(const SurfaceChunk& chunk, std::size_t number) {
        const std::array<glm::ivec3, 3> corners = corners_of(chunk, number);
        const int shift = LATTICE_BITS - region_.level;
        const interop::SurfaceTriangle& triangle = chunk.triangles[number];
        const interop::SurfaceMaterial& material = surface_.materials[triangle.material];
        const bool masked = (material.flags >> MATERIAL_MASK_BIT & 1U) != 0;
        if (!masked && mark_line(corners, shift)) return;
        const RowSpans spans(corners, shift);
        if (!masked) {
            const auto all = [](int, int, int) { return true; };
            mark(spans, all, true);
            return;
        }
        std::array<glm::i64vec3, 3> positions;
        std::array<glm::vec2, 3> texcoords;
        std::array<std::uint16_t, 3> alphas{};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& attributes = chunk.attributes[triangle.vertices[int(i)]];
            positions[i] = corners[i];
            texcoords[i] = voxelizer::texcoord_of(attributes);
            alphas[i] = voxelizer::alpha_of(attributes);
        }
        const voxelizer::ExactMask mask(positions, texcoords, alphas, material, surface_.texels);
        const std::int64_t side = region_.voxel_side();
        mark(
            spans, [&](int x, int y, int z) { return mask.touches(glm::i64vec3(x, y, z) * side, side); },
            false);
    }

private:
    /// Marks a triangle whose box is one voxel wide along two axes. It is connected, so it touches every
    /// voxel of the box. Most triangles are like that if they are smaller than voxels.
    bool mark_line(const std::array<glm::ivec3, 3>& p, int shift) {
        const glm::ivec3 low = low_voxel(p, shift);
        const glm::ivec3 high = high_voxel(p, shift);
        if (int(low.x != high.x) + int(low.y != high.y) + int(low.z != high.z) > 1) return false;
        const glm::ivec3 origin = region_.origin;
        const glm::ivec3 first = glm::max(low - origin, glm::ivec3(0, 0, slices_.first));
        const glm::ivec3 last =
            glm::min(high - origin, glm::ivec3(region_.size.x - 1, region_.size.y - 1, slices_.last));
        if (glm::any(glm::greaterThan(first, last))) return true;
        for (int z = first.z; z <= last.z; ++z) {
            for (int y = first.y; y <= last.y; ++y)
                set_bits(&bits_.words[bits_.word_index(0, y, z)], first.x, last.x);
        }
        return true;
    }

    /// @param whole_rows  true if every voxel of a row passes
    template <typename Passes>
    void mark(const RowSpans& spans, const Passes& passes, bool whole_rows) {
        const glm::ivec3 low = region_.origin;
        const glm::ivec3 high = region_.origin + region_.size - 1;
        const int last_z = std::min(spans.high().z, low.z + slices_.last);
        for (int z = std::max(spans.low().z, low.z + slices_.first); z <= last_z; ++z) {
            const RowSpans::Slice slice = spans.slice(z);
            const int last_y = std::min(slice.rows().last, high.y);
            for (int y = std::max(slice.rows().first, low.y); y <= last_y; ++y) {
                Span span = slice.row(y);
                span = {std::max(span.first, low.x), std::min(span.last, high.x)};
                if (span.empty()) continue;
                std::uint32_t* const row = &bits_.words[bits_.word_index(0, y - low.y, z - low.z)];
                if (whole_rows) {
                    set_bits(row, span.first - low.x, span.last - low.x);
                    continue;
                }
                for (int x = span.first; x <= span.last; ++x) {
                    if (passes(x, y, z)) set_bits(row, x - low.x, x - low.x);
                }
            }
        }
    }

    const Surface& surface_;
    const Region& region_;
    BitGrid& bits_;
    Span slices_;
};

}  // namespace

void mark_row_spans(const Surface& surface, const Region& region, BitGrid& bits) {
    const std::size_t slice_words = std::size_t(bits.words_per_row()) * std::size_t(region.size.y);
    const int slab_slices = int(std::clamp<std::size_t>(slab_bytes / (slice_words * 4), 1, 64));
    std::vector<SlabLists> lists;
    for (const SurfaceChunk& chunk : surface.chunks)
        lists.emplace_back(chunk, region, slab_slices);
    const int slab_count = (region.size.z + slab_slices - 1) / slab_slices;
    tbb::parallel_for(0, slab_count, [&](int slab) {
        const Span slices{slab * slab_slices, std::min((slab + 1) * slab_slices, region.size.z) - 1};
        const auto begin = bits.words.begin() + std::ptrdiff_t(slice_words) * slices.first;
        std::fill(begin, begin + std::ptrdiff_t(slice_words) * (slices.last - slices.first + 1), 0U);
        SlabMarker marker(surface, region, bits, slices);
        for (std::size_t chunk = 0; chunk < lists.size(); ++chunk) {
            for (const std::uint32_t triangle : lists[chunk].of(slab))
                marker.mark(surface.chunks[chunk], triangle);
        }
    });
    voxelizer::mark_far_triangles(surface.far_triangles, surface.materials, surface.texels, region, bits);
}

}  // namespace cairn::bench
