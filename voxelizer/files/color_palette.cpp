#include "voxelizer/files/color_palette.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::voxelizer {
namespace {

std::uint32_t packed(const glm::u8vec3& color) {
    return std::uint32_t(color.r) << 16 | std::uint32_t(color.g) << 8 | color.b;
}

std::size_t nearest(const std::vector<glm::dvec3>& colors, const glm::dvec3& color) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const glm::dvec3 off = colors[i] - color;
        const double distance = glm::dot(off, off);
        if (distance >= least) continue;
        least = distance;
        best = i;
    }
    return best;
}

}  // namespace

std::uint32_t ColorPalette::cell_of(const glm::u8vec3& color) {
    return std::uint32_t(color.r >> 2) << 12 | std::uint32_t(color.g >> 2) << 6 | std::uint32_t(color.b >> 2);
}

void ColorPalette::add(const glm::u8vec3& color) {
    Cell& cell = cells_[cell_of(color)];
    ++cell.count;
    for (int axis = 0; axis < 3; ++axis)
        cell.sums[std::size_t(axis)] += color[axis];
    if (exact_.size() <= capacity) exact_.try_emplace(packed(color), std::uint8_t(0));
}

void ColorPalette::build() {
    if (exact_.size() <= capacity) {
        for (auto& [color, index] : exact_) {
            index = std::uint8_t(colors_.size());
            colors_.emplace_back(color >> 16, color >> 8 & 0xFFU, color & 0xFFU);
        }
        return;
    }
    Cells all;
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
        if (cells_[cell].count != 0) all.push_back(cell);
    for (const Cells& part : cut_by_median(all))
        colors_.emplace_back(glm::round(mean_of(part)));
    move_to_means(all);
}

glm::dvec3 ColorPalette::mean_of(const Cells& cells) const {
    Cell sum;
    for (const std::uint32_t cell : cells) {
        sum.count += cells_[cell].count;
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum.sums[axis] += cells_[cell].sums[axis];
    }
    return sum.mean();
}

/// Cuts the part whose colours vary most, along the axis where they do, until there are enough.
std::vector<ColorPalette::Cells> ColorPalette::cut_by_median(const Cells& all) const {
    struct Part {
        Cells cells;
        double error = 0.0;  ///< sum of squared distances from the mean along `axis`
        int axis = 0;
    };
    const auto measured = [&](Cells cells) {
        Part part{std::move(cells)};
        const glm::dvec3 mean = mean_of(part.cells);
        glm::dvec3 error(0.0);
        for (const std::uint32_t cell : part.cells) {
            const glm::dvec3 off = cells_[cell].mean() - mean;
            error += double(cells_[cell].count) * off * off;
        }
        for (int axis = 1; axis < 3; ++axis)
            if (error[axis] > error[part.axis]) part.axis = axis;
        part.error = part.cells.size() > 1 ? error[part.axis] : 0.0;
        return part;
    };
    std::vector<Part> parts = {measured(all)};
    while (parts.size() < capacity) {
        const auto worst = std::ranges::max_element(parts, {}, &Part::error);
        if (worst->error <= 0.0) break;
        Cells cells = std::move(worst->cells);
        const int axis = worst->axis;
        std::ranges::stable_sort(cells, {}, [&](std::uint32_t cell) { return cells_[cell].mean()[axis]; });
        std::uint64_t total = 0;
        for (const std::uint32_t cell : cells)
            total += cells_[cell].count;
        std::size_t half = 0;
        for (std::uint64_t before = 0; half + 1 < cells.size() && 2 * before < total; ++half)
            before += cells_[cells[half]].count;
        half = std::max<std::size_t>(half, 1);
        const auto middle = cells.begin() + std::ptrdiff_t(half);
        *worst = measured(Cells(cells.begin(), middle));
        parts.push_back(measured(Cells(middle, cells.end())));
    }
    std::vector<Cells> out;
    out.reserve(parts.size());
    for (Part& part : parts)
        out.push_back(std::move(part.cells));
    return out;
}

void ColorPalette::move_to_means(const Cells& all) {
    std::vector<glm::dvec3> means(colors_.begin(), colors_.end());
    index_of_cell_.assign(cells_.size(), 0);
    constexpr int rounds = 4;
    for (int round = 0; round <= rounds; ++round) {
        std::vector<Cells> parts(means.size());
        for (const std::uint32_t cell : all) {
            const std::size_t index = nearest(means, cells_[cell].mean());
            index_of_cell_[cell] = std::uint8_t(index);
            parts[index].push_back(cell);
        }
        if (round == rounds) break;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (!parts[i].empty()) means[i] = mean_of(parts[i]);
    }
    for (std::size_t i = 0; i < means.size(); ++i)
        colors_[i] = glm::u8vec3(glm::round(means[i]));
}

std::uint8_t ColorPalette::index_of(const glm::u8vec3& color) const {
    if (index_of_cell_.empty()) return exact_.at(packed(color));
    return index_of_cell_[cell_of(color)];
}

}  // namespace cairn::voxelizer
