#include "renderer/pool/tree_shape.h"

#include <fmt/format.h>

#include "base/error.h"
#include "shaders/interop/config.h"

namespace cairn::renderer {

gl::Defines TreeShape::defines(bool has_color) const {
    return {{"TREE_N", std::to_string(n)},
            {"BRICK_M", std::to_string(m)},
            {"BRICK_MIPS", std::to_string(mips)},
            {"MAX_LEVEL", std::to_string(max_level)},
            {"HAS_COLOR", has_color ? "1" : "0"}};
}

TreeShape make_tree_shape(int n, int m, int max_resolution, bool with_mips) {
    if (n != 2 && n != 4) throw Error(Fault::usage, "tree", fmt::format("N = {} is not 2 or 4", n));
    if (m != 8 && m != 16 && m != 32 && m != 64) {
        throw Error(Fault::usage, "tree", fmt::format("M = {} is not 8, 16, 32 or 64", m));
    }
    if (max_resolution < m || max_resolution > 1 << MAX_RESOLUTION_BITS) {
        throw Error(Fault::usage, "maximum resolution",
                    fmt::format("{} is not between {} (one brick) and {}", max_resolution, m,
                                1 << MAX_RESOLUTION_BITS));
    }
    TreeShape shape{n, m, 0};
    shape.mips = with_mips ? shape.n_shift() : 0;
    while (std::int64_t(shape.resolution()) * n <= max_resolution)
        ++shape.max_level;
    return shape;
}

}  // namespace cairn::renderer
