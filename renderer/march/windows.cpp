#include "renderer/march/windows.h"

#include <algorithm>
#include <cmath>

namespace cairn::renderer {
namespace {

/// A point in units of a level's tiles: a whole number and a rest, so that no bit is lost.
struct SplitPoint {
    glm::i64vec3 whole{0};
    glm::dvec3 rest{0.0};
};

SplitPoint in_tiles(int level, const TreeShape& shape, const TilePoint& place) {
    const int finer = shape.n_shift() * (level - place.tile.level);
    if (finer >= 0) {
        const glm::dvec3 offset = place.offset * std::ldexp(1.0, finer);
        // A part that no whole number can hold stays in the rest: the point is too far away for its last bits
        // to matter.
        const glm::dvec3 whole = glm::floor(glm::clamp(offset, -0x1p61, 0x1p61));
        return {(place.tile.position << std::int64_t(finer)) + glm::i64vec3(whole), offset - whole};
    }
    const glm::i64vec3 whole = place.tile.position >> std::int64_t(-finer);
    const glm::i64vec3 low_bits = place.tile.position - (whole << std::int64_t(-finer));
    return {whole, (glm::dvec3(low_bits) + place.offset) * std::ldexp(1.0, finer)};
}

/// Distance, in voxels of a window, beyond which floats cannot distinguish a light from its direction.
constexpr double far_light = 0x1p40;

}  // namespace

std::vector<Window> windows_around(const TreeShape& shape, const TilePoint& eye) {
    std::vector<Window> windows;
    const int finest = std::max(0, shape.max_level - shape.levels_in_window());
    for (int level = 0; level <= finest; ++level) {
        const SplitPoint place = in_tiles(level, shape, eye);
        const glm::dvec3 about = glm::dvec3(place.whole) + place.rest;
        if (level == 0) {
            const glm::dvec3 corner = glm::clamp(glm::floor(about + 0.5), 0.0, 1.0);
            windows.push_back({0, glm::i64vec3(corner) - std::int64_t(1)});
            continue;
        }
        const std::int64_t across = std::int64_t(1) << (shape.n_shift() * level);
        if (glm::any(glm::greaterThan(glm::abs(about), glm::dvec3(double(across) + 2.0)))) break;
        const glm::i64vec3 low = place.whole + glm::i64vec3(glm::floor(place.rest + 0.5)) - std::int64_t(1);
        const bool touches = glm::all(glm::greaterThan(low, glm::i64vec3(-2))) &&
                             glm::all(glm::lessThan(low, glm::i64vec3(across)));
        if (!touches) break;
        windows.push_back({level, low});
    }
    std::reverse(windows.begin(), windows.end());
    return windows;
}

void drop_empty(std::vector<Window>& windows, const TreeShape& shape, Oracle& oracle) {
    // Tiles of the next coarser window that are not empty. The last window is always kept.
    std::vector<Tile> full = {Tile{}};
    for (std::size_t i = windows.size() - 1; i-- > 0;) {
        std::vector<Tile> inner;
        for (const Tile& parent : full) {
            const glm::uvec2 mask = oracle.child_mask(parent);
            for (int child = 0; child < shape.child_count(); ++child) {
                if ((mask[child / 32] >> (child % 32) & 1U) == 0) continue;
                const Tile tile = child_of(parent, shape.n, child);
                const glm::i64vec3 place = tile.position - windows[i].low;
                if (glm::all(glm::greaterThanEqual(place, glm::i64vec3(0))) &&
                    glm::all(glm::lessThan(place, glm::i64vec3(2))))
                    inner.push_back(tile);
            }
        }
        if (inner.empty()) {
            windows.erase(windows.begin(), windows.begin() + std::ptrdiff_t(i) + 1);
            return;
        }
        full = std::move(inner);
    }
}

glm::dvec3 point_in_window(const Window& window, const TreeShape& shape, const TilePoint& place) {
    const SplitPoint split = in_tiles(window.level, shape, place);
    const int shift = shape.m_shift() + shape.n_shift() * shape.levels_in_window();
    return (glm::dvec3(split.whole - window.low) + split.rest) * std::ldexp(1.0, shift);
}

std::vector<interop::MarchWindow> make_ray_windows(const std::vector<Window>& windows, const TreeShape& shape,
                                                   const TilePoint& eye, const TilePoint* light,
                                                   const glm::dvec3& towards) {
    std::vector<interop::MarchWindow> ray_windows;
    const int tile_shift = shape.m_shift() + shape.n_shift() * shape.levels_in_window();
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const Window& window = windows[i];
        interop::MarchWindow out{};
        const glm::dvec3 eye_here = point_in_window(window, shape, eye);
        out.eye = glm::vec3(eye_here);
        out.light = glm::vec3(glm::normalize(towards));
        if (light != nullptr) {
            const glm::dvec3 here = point_in_window(window, shape, *light);
            const bool is_far = glm::length(here) > far_light;
            out.light = glm::vec3(is_far ? glm::normalize(here) : here);
            out.light_is_positional = is_far ? 0 : 1;
        }
        if (i + 1 < windows.size()) {
            const glm::i64vec3 outer = windows[i + 1].low << std::int64_t(shape.n_shift());
            const glm::ivec3 tiles(window.low - outer);
            out.shift = tiles << (tile_shift - shape.n_shift());
        }
        out.level = window.level;
        ray_windows.push_back(out);
    }
    return ray_windows;
}

namespace {

/// The word of MarchWindow::tiles for a tile.
/// @param parent  the word for the tile's parent.
std::uint32_t child_of_tile(const Tree& tree, std::uint32_t parent, int child,
                            const std::function<void(std::uint32_t)>& subdivide) {
    if (parent == WINDOW_EMPTY || (parent & WINDOW_MISSING) != 0) return parent;
    if (!may_hold(tree.node(parent).child_mask, tree.shape().n, child)) return WINDOW_EMPTY;
    if (tree.node(parent).children == 0 && subdivide) subdivide(parent);
    const std::uint32_t children = tree.node(parent).children;
    return children == 0 ? WINDOW_MISSING | parent : children + std::uint32_t(child);
}

}  // namespace

void find_tiles(const std::vector<Window>& windows, const Tree& tree,
                std::vector<interop::MarchWindow>& ray_windows,
                const std::function<void(std::uint32_t)>& subdivide) {
    const TreeShape& shape = tree.shape();
    const std::int64_t n = shape.n;
    for (std::size_t i = windows.size(); i-- > 0;) {
        const Window& window = windows[i];
        for (int number = 0; number < 8; ++number) {
            const glm::i64vec3 tile = window.low + glm::i64vec3(number & 1, number >> 1 & 1, number >> 2);
            const std::int64_t across = std::int64_t(1) << (shape.n_shift() * window.level);
            std::uint32_t& entry_word = ray_windows[i].tiles[number / 4][number % 4];
            const bool in_root = glm::all(glm::greaterThanEqual(tile, glm::i64vec3(0))) &&
                                 glm::all(glm::lessThan(tile, glm::i64vec3(across)));
            if (!in_root) {
                entry_word = WINDOW_EMPTY;
            } else if (window.level == 0) {
                entry_word = 0;
            } else {
                // The parent is a tile of the next window, which is already known.
                const glm::i64vec3 parent = tile / n;
                const glm::ivec3 place(parent - windows[i + 1].low);
                const glm::ivec3 child(tile - parent * n);
                const glm::uvec4& row = ray_windows[i + 1].tiles[place.z];
                entry_word = child_of_tile(tree, row[place.x + 2 * place.y],
                                           child.x + shape.n * (child.y + shape.n * child.z), subdivide);
            }
        }
    }
}

}  // namespace cairn::renderer
