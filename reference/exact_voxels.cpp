#include "reference/exact_voxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/error.h"
#include "reference/embree.h"
#include "reference/separating_axes.h"
#include "shaders/interop/surface.h"
#include "voxelizer/surface/exact_mask.h"
#include "voxelizer/surface/surface_attributes.h"

namespace cairn::reference {
namespace {

using voxelizer::BitGrid;
using voxelizer::ExactMask;
using voxelizer::Region;
using voxelizer::Surface;

constexpr int cell_side = 8;  // voxels; candidates are asked for once a cell

/// A triangle of the surface, wherever it is kept. Far ones come last.
class Triangles {
public:
    explicit Triangles(const Surface& surface) : surface_(surface) {
        for (const voxelizer::SurfaceChunk& chunk : surface.chunks) {
            first_of_chunk_.push_back(near_count_);
            near_count_ += chunk.triangles.size();
        }
    }

    [[nodiscard]] std::size_t near_count() const { return near_count_; }
    [[nodiscard]] std::size_t count() const { return near_count_ + surface_.far_triangles.size(); }

    [[nodiscard]] std::array<glm::i64vec3, 3> positions(std::size_t triangle) const {
        if (triangle >= near_count_) return surface_.far_triangles[triangle - near_count_].positions;
        const Place place = at(triangle);
        std::array<glm::i64vec3, 3> out;
        for (int corner = 0; corner < 3; ++corner) {
            const auto& p = place.chunk->positions[place.triangle.vertices[corner]];
            out[std::size_t(corner)] = {p[0], p[1], p[2]};
        }
        return out;
    }

    /// The mask of a triangle; none if no mask cuts it.
    [[nodiscard]] std::optional<ExactMask> mask(std::size_t triangle) const {
        std::array<glm::vec2, 3> texcoords;
        std::array<std::uint16_t, 3> alphas{};
        std::uint32_t material = 0;
        if (triangle >= near_count_) {
            const voxelizer::FarTriangle& far_triangle = surface_.far_triangles[triangle - near_count_];
            texcoords = far_triangle.texcoords;
            alphas = far_triangle.alphas();
            material = far_triangle.material;
            if (!is_masked(material)) return std::nullopt;
        } else {
            const Place place = at(triangle);
            material = place.triangle.material;
            if (!is_masked(material)) return std::nullopt;
            for (int corner = 0; corner < 3; ++corner) {
                const interop::SurfaceAttributes& attributes =
                    place.chunk->attributes[place.triangle.vertices[corner]];
                texcoords[std::size_t(corner)] = voxelizer::texcoord_of(attributes);
                alphas[std::size_t(corner)] = voxelizer::alpha_of(attributes);
            }
        }
        return ExactMask(positions(triangle), texcoords, alphas, surface_.materials[material],
                         surface_.texels);
    }

private:
    struct Place {
        const voxelizer::SurfaceChunk* chunk;
        interop::SurfaceTriangle triangle;
    };

    [[nodiscard]] Place at(std::size_t triangle) const {
        const auto next = std::upper_bound(first_of_chunk_.begin(), first_of_chunk_.end(), triangle);
        const auto chunk = std::size_t(next - first_of_chunk_.begin()) - 1;
        const voxelizer::SurfaceChunk& found = surface_.chunks[chunk];
        return {&found, found.triangles[triangle - first_of_chunk_[chunk]]};
    }
    [[nodiscard]] bool is_masked(std::uint32_t material) const {
        return (surface_.materials[material].flags >> MATERIAL_MASK_BIT & 1U) != 0;
    }

    const Surface& surface_;
    std::vector<std::size_t> first_of_chunk_;
    std::size_t near_count_ = 0;
};

/// Which triangles may meet a box: a superset, found by Embree over bounding boxes that are rounded outwards.
class Candidates {
public:
    explicit Candidates(const Triangles& triangles) : triangles_(triangles), device_(rtcNewDevice(nullptr)) {
        if (device_ == nullptr) throw Error(Fault::memory, "reference", "Embree cannot start");
        scene_.reset(rtcNewScene(device_.get()));
        const EmbreeGeometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
        rtcSetGeometryUserPrimitiveCount(geometry.get(), unsigned(triangles.near_count()));
        rtcSetGeometryUserData(geometry.get(), this);
        rtcSetGeometryBoundsFunction(geometry.get(), write_bounds, nullptr);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcCommitScene(scene_.get());
        if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
            throw Error(Fault::memory, "reference", "Embree cannot hold the triangles",
                        "choose a smaller scene");
        }
    }

    [[nodiscard]] std::vector<std::uint32_t> near_box(const glm::i64vec3& low,
                                                      const glm::i64vec3& high) const {
        const glm::dvec3 centre = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
        std::vector<std::uint32_t> found;
        RTCPointQuery query;
        query.x = float(centre.x);
        query.y = float(centre.y);
        query.z = float(centre.z);
        query.time = 0.0F;
        // Wider than the box's half diagonal by more than all roundings of 24-bit numbers below 2^26.
        query.radius = float(glm::length(0.5 * glm::dvec3(high - low)) * 1.001 + 64.0);
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        const auto add = [](RTCPointQueryFunctionArguments* arguments) {
            static_cast<std::vector<std::uint32_t>*>(arguments->userPtr)->push_back(arguments->primID);
            return false;  // the radius stays
        };
        rtcPointQuery(scene_.get(), &query, &context, add, &found);
        return found;
    }

private:
    static void write_bounds(const RTCBoundsFunctionArguments* arguments) {
        const auto* const self = static_cast<const Candidates*>(arguments->geometryUserPtr);
        const auto [a, b, c] = self->triangles_.positions(arguments->primID);
        constexpr double pad = 8.0;  // over the 2 units that a float below 2^25 may be off
        const glm::vec3 low(glm::dvec3(glm::min(glm::min(a, b), c)) - pad);
        const glm::vec3 high(glm::dvec3(glm::max(glm::max(a, b), c)) + pad);
        *arguments->bounds_o = {low.x, low.y, low.z, 0.0F, high.x, high.y, high.z, 0.0F};
    }

    const Triangles& triangles_;
    EmbreeDevice device_;
    EmbreeScene scene_;
};

/// Fills one cell of voxels, halving it and its candidates until single voxels are left.
class CellFiller {
public:
    CellFiller(const Triangles& triangles, const Region& region, BitGrid& bits)
        : triangles_(triangles), region_(region), bits_(bits) {}

    /// @param low  voxel, in the region
    void fill(const glm::ivec3& low, int side, const std::vector<std::uint32_t>& candidates) {
        if (glm::any(glm::greaterThanEqual(low, region_.size))) return;
        const std::int64_t unit = region_.voxel_side();
        const glm::i64vec3 box_low = glm::i64vec3(region_.origin + low) * unit;
        std::vector<std::uint32_t> inside;
        for (const std::uint32_t triangle : candidates) {
            if (!triangle_meets_box(triangles_.positions(triangle), box_low,
                                    box_low + std::int64_t(side) * unit)) {
                continue;
            }
            if (side > 1) {
                inside.push_back(triangle);
                continue;
            }
            const std::optional<ExactMask> mask = triangles_.mask(triangle);
            if (mask && !mask->touches(box_low, unit)) continue;
            bits_.set(low);
            return;
        }
        if (inside.empty()) return;
        const int half = side / 2;
        for (int child = 0; child < 8; ++child) {
            fill(low + half * glm::ivec3(child & 1, child >> 1 & 1, child >> 2), half, inside);
        }
    }

private:
    const Triangles& triangles_;
    const Region& region_;
    BitGrid& bits_;
};

}  // namespace

struct ExactVoxels::Impl {
    explicit Impl(const Surface& surface) : triangles(surface), candidates(triangles) {}

    Triangles triangles;
    Candidates candidates;
};

ExactVoxels::ExactVoxels(const Surface& surface) : impl_(std::make_unique<Impl>(surface)) {}
ExactVoxels::~ExactVoxels() = default;

BitGrid ExactVoxels::in(const Region& region) const {
    const Triangles& triangles = impl_->triangles;
    const Candidates& candidates = impl_->candidates;
    BitGrid bits(region.size);
    const glm::ivec3 cells = (region.size + cell_side - 1) / cell_side;
    const std::int64_t unit = region.voxel_side();
    const glm::i64vec3 region_low = glm::i64vec3(region.origin) * unit;
    if (triangles.near_count() == triangles.count() &&
        candidates.near_box(region_low, region_low + glm::i64vec3(region.size) * unit).empty()) {
        return bits;
    }
    // Columns of cells along x share no word with others.
    tbb::parallel_for(0, cells.y * cells.z, [&](int column) {
        CellFiller filler(triangles, region, bits);
        for (int x = 0; x < cells.x; ++x) {
            const glm::ivec3 low = cell_side * glm::ivec3(x, column % cells.y, column / cells.y);
            const glm::i64vec3 box_low = glm::i64vec3(region.origin + low) * unit;
            std::vector<std::uint32_t> found = candidates.near_box(box_low, box_low + unit * cell_side);
            for (std::size_t i = triangles.near_count(); i < triangles.count(); ++i)
                found.push_back(std::uint32_t(i));
            filler.fill(low, cell_side, found);
        }
    });
    return bits;
}

BitGrid exact_voxels(const Surface& surface, const Region& region) {
    return ExactVoxels(surface).in(region);
}

Comparison compare(const BitGrid& ours, const BitGrid& truth) {
    Comparison out;
    out.occupied = truth.count();
    const int words_per_row = truth.words_per_row();
    for (std::size_t i = 0; i < truth.words.size(); ++i) {
        const std::uint32_t missing = truth.words[i] & ~ours.words[i];
        const std::uint32_t extra = ours.words[i] & ~truth.words[i];
        out.missing += std::uint64_t(std::popcount(missing));
        out.extra += std::uint64_t(std::popcount(extra));
        const auto row = std::int64_t(i / std::size_t(words_per_row));
        for (std::uint32_t left = missing | extra; left != 0 && out.first_different.size() < 8;
             left &= left - 1) {
            out.first_different.emplace_back(
                int(i % std::size_t(words_per_row)) * 32 + std::countr_zero(left), row % truth.size.y,
                row / truth.size.y);
        }
    }
    return out;
}

}  // namespace cairn::reference
