#pragma once

#include "renderer/march/march_options.h"
#include "renderer/pool/pool_sizes.h"

namespace cairn::renderer {

/// How a renderer works. No picture depends on it. The tree is the content's (renderer/pool/tree_options.h).
struct RendererOptions {
    PoolSizes pools = {};
    MarchOptions march = {};
    bool operator==(const RendererOptions&) const = default;
};

}  // namespace cairn::renderer
