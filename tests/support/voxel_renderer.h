#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "renderer/open_content.h"
#include "renderer/pool/packed_bricks.h"
#include "renderer/renderer.h"

namespace cairn::test {

/// Options of a content's tree and of its renderer in one, as tests vary them.
struct Settings {
    renderer::TreeOptions tree = {};
    renderer::PoolSizes pools = {};
    renderer::MarchOptions march = {};
    [[nodiscard]] renderer::RendererOptions options() const { return {pools, march}; }
};

inline renderer::Renderer voxel_renderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                                         const Settings& settings = {}) {
    return renderer::Renderer(renderer::surface_content(scene, snapshot, settings.tree), settings.options());
}

/// @param volume  a scenes::Volume, or a shared pointer to a renderer::Field.
template <typename Volume>
renderer::Renderer voxel_renderer(const Volume& volume, const renderer::TransferFunction& transfer,
                                  const Settings& settings = {},
                                  const renderer::VolumeOptions& options = {}) {
    return renderer::Renderer(renderer::volume_content(volume, transfer, settings.tree, options),
                              settings.options());
}

/// Bytes of a pool for a share of the bricks that a frame left in its pool; for one full brick at least.
inline std::size_t pool_for(const renderer::FrameStatistics& frame, double share,
                            const renderer::TreeOptions& tree = {}, bool has_color = false) {
    return std::max(std::size_t(share * double(frame.brick_bytes_resident)),
                    renderer::least_packed_bytes(renderer::tree_shape_of(tree), has_color));
}

}  // namespace cairn::test
