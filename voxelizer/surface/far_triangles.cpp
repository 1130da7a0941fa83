// The row spans of shaders/voxelize/exact_triangle.glsl, whose comments explain the method, in wider
// integers.
#include "voxelizer/surface/far_triangles.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "voxelizer/surface/exact_mask.h"
#include "voxelizer/surface/wide_integer.h"

namespace cairn::voxelizer {
namespace {

struct Span {
    std::int64_t first, last;
    [[nodiscard]] bool empty() const { return first > last; }
};

/// A projected triangle, counter-clockwise; its longest side there and back when it has no area.
using Outline = std::array<glm::i64vec2, 3>;

Outline wind(const Outline& corners) {
    const glm::i64vec2 ab = corners[1] - corners[0];
    const glm::i64vec2 ac = corners[2] - corners[0];
    const Int128 area = Int128(ab.x) * ac.y - Int128(ab.y) * ac.x;
    if (area > 0) return corners;
    if (area < 0) return {corners[0], corners[2], corners[1]};
    std::size_t longest = 0;
    std::int64_t length = -1;
    for (std::size_t side = 0; side < 3; ++side) {
        const glm::i64vec2 d = glm::abs(corners[(side + 1) % 3] - corners[side]);
        if (d.x + d.y > length) {
            length = d.x + d.y;
            longest = side;
        }
    }
    return {corners[longest], corners[(longest + 1) % 3], corners[longest]};
}

class FarRows {
public:
    FarRows(const FarTriangle& triangle, std::int64_t side) : side_(side), corner_(triangle.positions[0]) {
        const auto& [a, b, c] = triangle.positions;
        const glm::i64vec3 low = glm::min(glm::min(a, b), c);
        const glm::i64vec3 high = glm::max(glm::max(a, b), c);
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = std::int64_t(ceil_divide(low[axis], side)) - 1;
            high_[axis] = std::int64_t(floor_divide(high[axis], side));
        }
        yz_ = wind({glm::i64vec2(a.y, a.z), glm::i64vec2(b.y, b.z), glm::i64vec2(c.y, c.z)});
        xy_ = wind({glm::i64vec2(a.x, a.y), glm::i64vec2(b.x, b.y), glm::i64vec2(c.x, c.y)});
        xz_ = wind({glm::i64vec2(a.x, a.z), glm::i64vec2(b.x, b.z), glm::i64vec2(c.x, c.z)});
        const glm::i64vec3 ab = b - a;
        const glm::i64vec3 ac = c - a;
        normal_ = cross({ab.x, ab.y, ab.z}, {ac.x, ac.y, ac.z});
        if (normal_.x < 0) normal_ = {-normal_.x, -normal_.y, -normal_.z};
    }

    [[nodiscard]] const glm::i64vec3& low() const { return low_; }
    [[nodiscard]] const glm::i64vec3& high() const { return high_; }

    [[nodiscard]] Span row_span(std::int64_t y, std::int64_t z) const {
        const glm::i64vec2 row(y * side_, z * side_);
        Span span{low_.x, high_.x};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!meets(yz_[i], yz_[(i + 1) % 3], row)) return {1, 0};
            narrow(span, xy_[i], xy_[(i + 1) % 3], row.x);
            narrow(span, xz_[i], xz_[(i + 1) % 3], row.y);
        }
        narrow_by_plane(span, row);
        return span;
    }

private:
    [[nodiscard]] bool meets(const glm::i64vec2& p, const glm::i64vec2& q, const glm::i64vec2& row) const {
        const glm::i64vec2 inward(p.y - q.y, q.x - p.x);
        const std::int64_t y = row.x + (inward.x > 0 ? side_ : 0);
        const std::int64_t z = row.y + (inward.y > 0 ? side_ : 0);
        return Int128(inward.x) * (y - p.x) + Int128(inward.y) * (z - p.y) >= 0;
    }

    void narrow(Span& span, const glm::i64vec2& p, const glm::i64vec2& q, std::int64_t row) const {
        const glm::i64vec2 inward(p.y - q.y, q.x - p.x);
        if (inward.x == 0) return;
        const Int128 rest = Int128(inward.y) * (row + (inward.y > 0 ? side_ : 0) - p.y);
        bound(span, inward.x > 0, Int128(inward.x) * p.x - rest, Int128(inward.x));
    }

    void narrow_by_plane(Span& span, const glm::i64vec2& row) const {
        if (normal_.x == 0) return;
        for (const bool lower : {true, false}) {
            const std::int64_t y = row.x + ((normal_.y > 0) == lower ? side_ : 0) - corner_.y;
            const std::int64_t z = row.y + ((normal_.z > 0) == lower ? side_ : 0) - corner_.z;
            bound(span, lower, normal_.x * corner_.x - normal_.y * y - normal_.z * z, normal_.x);
        }
    }

    /// x >= or <= numerator / divisor, for the upper or the lower corner of a voxel.
    void bound(Span& span, bool lower, Int128 numerator, Int128 divisor) const {
        if (divisor < 0) {
            numerator = -numerator;
            divisor = -divisor;
        }
        if (lower) {
            span.first =
                std::int64_t(std::max<Int128>(span.first, ceil_divide(numerator, divisor * side_) - 1));
        } else {
            span.last = std::int64_t(std::min<Int128>(span.last, floor_divide(numerator, divisor * side_)));
        }
        if (span.first > high_.x) span = {1, 0};
        if (span.last < low_.x) span = {1, 0};
    }

    std::int64_t side_;
    glm::i64vec3 corner_, low_, high_;
    Outline yz_, xy_, xz_;
    Wide3 normal_;
};

}  // namespace

void mark_far_triangles(std::span<const FarTriangle> triangles,
                        std::span<const interop::SurfaceMaterial> materials,
                        std::span<const std::uint32_t> texels, const Region& region, BitGrid& bits) {
    const std::int64_t side = region.voxel_side();
    for (const FarTriangle& triangle : triangles) {
        const FarRows rows(triangle, side);
        const glm::i64vec3 low = glm::max(rows.low(), glm::i64vec3(region.origin));
        const glm::i64vec3 high = glm::min(rows.high(), glm::i64vec3(region.origin + region.size - 1));
        const interop::SurfaceMaterial& material = materials[triangle.material];
        const bool masked = (material.flags >> MATERIAL_MASK_BIT & 1U) != 0;
        const ExactMask mask(triangle.positions, triangle.texcoords, triangle.alphas(), material, texels);
        // Slices of z share no word.
        tbb::parallel_for(low.z, high.z + 1, [&](std::int64_t z) {
            for (std::int64_t y = low.y; y <= high.y; ++y) {
                const Span span = rows.row_span(y, z);
                for (std::int64_t x = std::max(span.first, low.x); x <= std::min(span.last, high.x); ++x) {
                    const glm::i64vec3 voxel(x, y, z);
                    if (!masked || mask.touches(voxel * side, side))
                        bits.set(glm::ivec3(voxel) - region.origin);
                }
            }
        });
    }
}

}  // namespace cairn::voxelizer
