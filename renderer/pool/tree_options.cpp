#include "renderer/pool/tree_options.h"

#include "base/error.h"

namespace cairn::renderer {

TreeShape tree_shape_of(const TreeOptions& options) {
    if (!options.max_level)
        return make_tree_shape(options.n, options.m, options.max_resolution, options.mips);
    if (options.mips) {
        throw Error(Fault::usage, "tree", "bricks of a tree of any depth have no mip levels",
                    "leave the mips and blended levels of detail to surfaces");
    }
    return make_deep_tree_shape(options.n, options.m, *options.max_level);
}

}  // namespace cairn::renderer
