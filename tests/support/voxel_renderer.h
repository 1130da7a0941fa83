#pragma once

#include <memory>
#include <utility>

#include "renderer/open_content.h"
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

}  // namespace cairn::test
