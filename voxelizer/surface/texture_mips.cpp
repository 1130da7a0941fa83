#include "voxelizer/surface/texture_mips.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "optics/srgb.h"

namespace cairn::voxelizer {
namespace {

/// A texel of one level: linear colour times the share that is kept, and that share.
using Kept = glm::vec4;

/// Linear values of the 256 steps of sRGB.
const std::array<float, 256>& linear_steps() {
    static const std::array<float, 256> steps = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = float(optics::linear_from_srgb(double(i) / 255.0));
        return values;
    }();
    return steps;
}

Kept kept_of(std::uint32_t texel, std::uint32_t lowest_alpha) {
    if ((texel >> 24U) < lowest_alpha) return Kept(0.0F);
    const std::array<float, 256>& linear = linear_steps();
    return {linear[texel & 255U], linear[texel >> 8U & 255U], linear[texel >> 16U & 255U], 1.0F};
}

std::uint32_t encoded(const Kept& kept) {
    if (!(kept.a > 0.0F)) return 0;
    const glm::uvec3 color(optics::srgb8_from_linear(glm::vec3(kept) / kept.a));
    const std::uint32_t alpha =
        kept.a >= 1.0F - 1e-5F ? 255U : std::uint32_t(std::clamp(std::lround(kept.a * 255.0F), 1L, 254L));
    return color.r | color.g << 8U | color.b << 16U | alpha << 24U;
}

/// The texels of the finer level under a texel of the coarser one along an axis, and their weights.
struct Under {
    int first = 0;
    int count = 1;
    std::array<float, 4> weights{};
};

/// A side is at most 2 + 1/1 times the coarser one, so that a texel covers at most 4 finer ones.
std::vector<Under> under_each(int finer, int coarser) {
    std::vector<Under> all(static_cast<std::size_t>(coarser));
    const double step = double(finer) / coarser;
    for (int i = 0; i < coarser; ++i) {
        Under& under = all[std::size_t(i)];
        const double low = i * step;
        const double high = i + 1 == coarser ? double(finer) : (i + 1) * step;
        under.first = std::min(int(low), finer - 1);
        under.count = std::clamp(int(std::ceil(high - 1e-9)) - under.first, 1, 4);
        for (int k = 0; k < under.count; ++k) {
            const double from = std::max(low, double(under.first + k));
            const double to = std::min(high, double(under.first + k + 1));
            under.weights[std::size_t(k)] = float(std::max(to - from, 0.0) / step);
        }
    }
    return all;
}

/// The coarser level. `at(x, y)` is the finer one.
template <typename At>
std::vector<Kept> halved(const glm::ivec2& finer, const glm::ivec2& coarser, const At& at) {
    const std::vector<Under> columns = under_each(finer.x, coarser.x);
    const std::vector<Under> rows = under_each(finer.y, coarser.y);
    std::vector<Kept> out;
    out.reserve(std::size_t(coarser.x) * std::size_t(coarser.y));
    for (const Under& row : rows) {
        for (const Under& column : columns) {
            Kept sum(0.0F);
            for (int j = 0; j < row.count; ++j) {
                for (int i = 0; i < column.count; ++i)
                    sum += row.weights[std::size_t(j)] * column.weights[std::size_t(i)] *
                           at(column.first + i, row.first + j);
            }
            out.push_back(sum);
        }
    }
    return out;
}

}  // namespace

std::size_t mip_texels(const glm::ivec2& size) {
    std::size_t count = 0;
    for (glm::ivec2 level = size; level != glm::ivec2(1);) {
        level = coarser_mip_size(level);
        count += std::size_t(level.x) * std::size_t(level.y);
    }
    return count;
}

std::vector<std::uint32_t> mips_of(std::span<const std::uint32_t> texels, const glm::ivec2& size,
                                   std::uint32_t lowest_alpha) {
    std::vector<std::uint32_t> out;
    out.reserve(mip_texels(size));
    std::vector<Kept> finer;
    for (glm::ivec2 level = size; level != glm::ivec2(1);) {
        const glm::ivec2 coarser = coarser_mip_size(level);
        const auto stride = std::size_t(level.x);
        finer =
            finer.empty()
                ? halved(level, coarser,
                         [&](int x, int y) {
                             return kept_of(texels[std::size_t(y) * stride + std::size_t(x)], lowest_alpha);
                         })
                : halved(level, coarser,
                         [&](int x, int y) { return finer[std::size_t(y) * stride + std::size_t(x)]; });
        for (const Kept& kept : finer)
            out.push_back(encoded(kept));
        level = coarser;
    }
    return out;
}

std::vector<std::uint32_t> filled_levels(std::span<const std::uint32_t> texels, const glm::ivec2& size,
                                         std::uint32_t lowest_alpha) {
    std::vector<std::uint32_t> out(texels.begin(), texels.end());
    const std::vector<std::uint32_t> mips = mips_of(texels, size, lowest_alpha);
    out.insert(out.end(), mips.begin(), mips.end());
    if (lowest_alpha == 0) return out;
    struct Level {
        std::size_t first = 0;
        glm::ivec2 size{1};
    };
    std::vector<Level> levels = {{0, size}};
    while (levels.back().size != glm::ivec2(1)) {
        const Level& finer = levels.back();
        levels.push_back({finer.first + std::size_t(finer.size.x) * std::size_t(finer.size.y),
                          coarser_mip_size(finer.size)});
    }
    constexpr std::uint32_t color_bits = 0x00FFFFFFU;
    for (std::size_t i = levels.size() - 1; i-- > 0;) {
        const Level& level = levels[i];
        const Level& coarser = levels[i + 1];
        for (int y = 0; y < level.size.y; ++y) {
            for (int x = 0; x < level.size.x; ++x) {
                std::uint32_t& texel =
                    out[level.first + std::size_t(y) * std::size_t(level.size.x) + std::size_t(x)];
                if ((texel >> 24U) >= (i == 0 ? lowest_alpha : 1U)) continue;
                const glm::ivec2 under = glm::min(glm::ivec2(x / 2, y / 2), coarser.size - 1);
                const std::uint32_t color =
                    out[coarser.first + std::size_t(under.y) * std::size_t(coarser.size.x) +
                        std::size_t(under.x)];
                texel = (texel & ~color_bits) | (color & color_bits);
            }
        }
    }
    return out;
}

}  // namespace cairn::voxelizer
