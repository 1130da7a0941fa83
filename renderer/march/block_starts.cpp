#include "renderer/march/block_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/march/front_cells.h"

namespace cairn::renderer {
namespace {

using glm::dvec3;

/// Pixels around a box that count as covered, for the rounding of directions.
constexpr double pixel_margin = 0.25;
/// Depth, in voxels, below which nothing is projected.
constexpr double least_depth = 1e-3;
/// Margin for the rounding of positions, as a share of the largest coordinate: a few steps of a float.
constexpr double place_margin = 0x1p-21;

class BlockGrid {
public:
    BlockGrid(const interop::MarchView& view, double root_side, bool is_blended)
        : view_(view),
          is_blended_(is_blended),
          forward_(view.forward),
          eye_(dvec3(view.eye) - double(view.skipped) * forward_),
          across_(dvec3(view.right) / glm::dot(dvec3(view.right), dvec3(view.right))),
          down_(dvec3(view.up) / -glm::dot(dvec3(view.up), dvec3(view.up))),
          half_size_(0.5 * view.width, 0.5 * view.height),
          slack_(place_margin * (root_side + glm::length(dvec3(view.eye)))),
          count_((view.width + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE,
                 (view.row_count + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE),
          near_(std::size_t(count_.x) * std::size_t(count_.y), std::numeric_limits<double>::infinity()),
          far_(near_.size(), 0.0) {}

    [[nodiscard]] ConeOfSight cone() const { return {eye_, double(view_.pixel_cone), is_blended_}; }

    /// Does any ray of the band come near the box?
    [[nodiscard]] bool sees(const Box& box) const {
        const Rectangle r = project(box);
        return r.low.x <= r.high.x && r.low.y <= r.high.y;
    }

    void add(const Box& box) {
        const Rectangle r = project(box);
        if (r.low.x > r.high.x || r.low.y > r.high.y) return;
        const double near = cone().distance_to(box) * (1.0 - 1e-6) - 2.0 * slack_;
        const double far = cone().distance_past(box) * (1.0 + 1e-6) + 2.0 * slack_;
        for (int y = r.low.y / PIXEL_BLOCK_SIDE; y <= r.high.y / PIXEL_BLOCK_SIDE; ++y) {
            for (int x = r.low.x / PIXEL_BLOCK_SIDE; x <= r.high.x / PIXEL_BLOCK_SIDE; ++x) {
                const std::size_t block = std::size_t(y) * std::size_t(count_.x) + std::size_t(x);
                near_[block] = std::min(near_[block], near);
                far_[block] = std::max(far_[block], far);
            }
        }
    }

    [[nodiscard]] std::vector<interop::BlockStart> starts() const {
        std::vector<interop::BlockStart> starts;
        for (std::size_t block = 0; block < near_.size(); ++block) {
            if (near_[block] > far_[block]) continue;
            starts.push_back({interop::uint(block), float(std::max(near_[block], 0.0)), float(far_[block])});
        }
        return starts;
    }

private:
    /// Pixels of the band, both ends included; empty when low is above high.
    struct Rectangle {
        glm::ivec2 low, high;
    };

    [[nodiscard]] Rectangle project(const Box& box) const {
        const glm::ivec2 last(view_.width - 1, view_.row_count - 1);
        const dvec3 middle = 0.5 * (box.low + box.high) - eye_;
        const dvec3 half = 0.5 * (box.high - box.low) + slack_;
        const double depth = glm::dot(middle, forward_);
        const double half_depth = glm::dot(half, glm::abs(forward_));
        if (depth + half_depth < least_depth) return {glm::ivec2(0), glm::ivec2(-1)};
        // A box that the eye's plane cuts may cover any pixel.
        if (depth - half_depth < least_depth) return {glm::ivec2(0), last};
        const glm::dvec2 place(glm::dot(middle, across_), glm::dot(middle, down_));
        const glm::dvec2 reach(glm::dot(half, glm::abs(across_)), glm::dot(half, glm::abs(down_)));
        const double nearest = 1.0 / (depth - half_depth);
        const double farthest = 1.0 / (depth + half_depth);
        const glm::dvec2 low = glm::min((place - reach) * nearest, (place - reach) * farthest);
        const glm::dvec2 high = glm::max((place + reach) * nearest, (place + reach) * farthest);
        const glm::dvec2 first_pixel(-double(view_.pixel_x),
                                     -double(view_.pixel_y) - double(view_.first_row));
        const glm::dvec2 low_pixel = glm::ceil((low + 1.0) * half_size_ + first_pixel - pixel_margin);
        const glm::dvec2 high_pixel = glm::floor((high + 1.0) * half_size_ + first_pixel + pixel_margin);
        return {glm::ivec2(glm::clamp(low_pixel, glm::dvec2(0.0), glm::dvec2(last + 1))),
                glm::ivec2(glm::clamp(high_pixel, glm::dvec2(-1.0), glm::dvec2(last)))};
    }

    const interop::MarchView& view_;
    bool is_blended_;
    dvec3 forward_;
    dvec3 eye_;
    /// The dot product with a point from the eye, at depth 1, is the point's x on the picture, [-1, 1].
    dvec3 across_;
    dvec3 down_;  ///< like `across_`, for y
    glm::dvec2 half_size_;
    double slack_;
    glm::ivec2 count_;
    std::vector<double> near_;
    std::vector<double> far_;
};

}  // namespace

std::vector<interop::BlockStart> block_starts(const interop::MarchView& view, const Tree& tree,
                                              bool is_blended) {
    BlockGrid grid(view, double(tree.shape().resolution()), is_blended);
    FrontCells(
        tree, grid.cone(), [&](const Box& box) { return grid.sees(box); },
        [&](const Box& box) { grid.add(box); })
        .walk();
    return grid.starts();
}

namespace {

int block_count(const interop::MarchView& view) {
    const glm::ivec2 count((view.width + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE,
                           (view.row_count + PIXEL_BLOCK_SIDE - 1) / PIXEL_BLOCK_SIDE);
    return count.x * count.y;
}

}  // namespace

std::vector<interop::BlockStart> all_block_starts(const interop::MarchView& view) {
    std::vector<interop::BlockStart> starts;
    starts.reserve(std::size_t(block_count(view)));
    for (int block = 0; block < block_count(view); ++block)
        starts.push_back({interop::uint(block), 0.0F, 1e30F});
    return starts;
}

void add_empty_blocks(const interop::MarchView& view, std::vector<interop::BlockStart>& starts) {
    std::vector<bool> there(std::size_t(block_count(view)), false);
    for (const interop::BlockStart& start : starts)
        there[start.block] = true;
    for (std::size_t block = 0; block < there.size(); ++block)
        if (!there[block]) starts.push_back({interop::uint(block), 0.0F, 0.0F});
}

}  // namespace cairn::renderer
