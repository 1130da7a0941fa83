#include "renderer/pool/tree_shape.h"

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/config.h"

namespace cairn::renderer {

/// Positions of voxels and their borders stay within 63 bits.
constexpr int most_voxel_bits = 60;

gl::Defines TreeShape::defines(bool has_color) const {
    return {{"TREE_N", std::to_string(n)},
            {"BRICK_M", std::to_string(m)},
            {"MAX_LEVEL", std::to_string(has_windows() ? levels_in_window() : max_level)},
            {"WINDOWS", has_windows() ? "1" : "0"},
            {"HAS_COLOR", has_color ? "1" : "0"}};
}

bool TreeShape::has_windows() const {
    return voxel_level(max_level) > MAX_RESOLUTION_BITS;
}

int TreeShape::levels_in_window() const {
    return (window_tile_bits - m_shift()) / n_shift();
}

namespace {

void check_factors(int n, int m) {
    if (n != 2 && n != 4) throw Error(Fault::usage, "tree", fmt::format("N = {} is not 2 or 4", n));
    if (m != 8 && m != 16 && m != 32 && m != 64) {
        throw Error(Fault::usage, "tree", fmt::format("M = {} is not 8, 16, 32 or 64", m));
    }
}

}  // namespace

TreeShape make_tree_shape(int n, int m, int max_resolution) {
    check_factors(n, m);
    if (max_resolution < m || max_resolution > 1 << MAX_RESOLUTION_BITS) {
        throw Error(Fault::usage, "maximum resolution",
                    fmt::format("{} is not between {} (one brick) and {}", max_resolution, m,
                                1 << MAX_RESOLUTION_BITS));
    }
    TreeShape shape{.n = n, .m = m, .max_level = 0};
    while (std::int64_t(shape.resolution()) * n <= max_resolution)
        ++shape.max_level;
    return shape;
}

TreeShape make_deep_tree_shape(int n, int m, int max_level) {
    check_factors(n, m);
    const TreeShape shape{.n = n, .m = m, .max_level = max_level};
    const int most = (most_voxel_bits - shape.m_shift()) / shape.n_shift();
    if (max_level < 0 || max_level > most) {
        throw Error(Fault::usage, "tree", fmt::format("{} levels are not between 0 and {}", max_level, most));
    }
    return shape;
}

}  // namespace cairn::renderer
