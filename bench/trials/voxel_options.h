#pragma once

#include <cstdint>
#include <optional>

#include "renderer/pool/tree_shape.h"
#include "renderer/produce/volume.h"
#include "renderer/renderer.h"

namespace cairn::bench {

/// Options of rendering voxels that a chart may not vary itself; none: the chart's own choice.
struct VoxelOptions {
    std::optional<int> tree_n, brick_m, max_resolution;
    std::optional<renderer::Traversal> traversal;
    std::optional<renderer::TileQueries> tile_queries;
    /// Steps of a ray per voxel of a volume.
    std::optional<int> steps_per_voxel;
    /// Gradient of a volume from which on it is lit as a surface, in densities per voxel.
    std::optional<double> gradient_threshold;
    std::optional<double> frame_budget_ms;

    /// The chart's own choice `own`, with the options that are given here in its place.
    /// @{
    [[nodiscard]] renderer::TreeOptions tree(renderer::TreeOptions own = {}) const {
        own.n = tree_n.value_or(own.n);
        own.m = brick_m.value_or(own.n == 3 && own.m == renderer::TreeOptions{}.m ? 27 : own.m);
        own.max_resolution = max_resolution.value_or(own.max_resolution);
        return own;
    }
    [[nodiscard]] renderer::RendererOptions renderer(renderer::RendererOptions own = {}) const {
        own.march.traversal = traversal.value_or(own.march.traversal);
        own.march.tile_queries = tile_queries.value_or(own.march.tile_queries);
        return own;
    }
    [[nodiscard]] renderer::VolumeOptions volume(renderer::VolumeOptions own = {}) const {
        own.steps_per_voxel = steps_per_voxel.value_or(own.steps_per_voxel);
        own.full_gradient = gradient_threshold.value_or(own.full_gradient);
        return own;
    }
    [[nodiscard]] renderer::Request request() const {
        renderer::Request request;
        if (frame_budget_ms) request.budget = Milliseconds(*frame_budget_ms);
        return request;
    }
    /// @}
};

/// The options of VoxelOptions that a chart takes.
struct VoxelOptionsTaken {
    bool tree = false;  ///< N, M and the resolution
    bool traversal = false;
    bool tile_queries = false;
    bool volume = false;  ///< steps per voxel, and the gradient's threshold
    bool frame_budget = false;
};

}  // namespace cairn::bench
