#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "renderer/mesh/mesh_raster.h"
#include "renderer/renderer.h"
#include "scenes/snapshot.h"
#include "tests/support/voxel_renderer.h"
#include "voxelizer/grid.h"

/// Pictures of meshes beside voxels, and their comparison.
namespace cairn::test {

using optics::Image;
using renderer::MeshRaster;
using renderer::Renderer;
using renderer::View;

inline const glm::vec4 red(0.8F, 0.02F, 0.02F, 1.0F);

inline std::shared_ptr<MeshRaster> raster(const scenes::Scene& scene) {
    return std::make_shared<MeshRaster>(scene, scenes::take_snapshot(scene));
}

inline Renderer voxels_of(const scenes::Scene& scene, int resolution) {
    return voxel_renderer(scene, scenes::take_snapshot(scene), {.tree = {.max_resolution = resolution}});
}

/// A view lit from everywhere, with the finest voxels: a pixel's colour is that of the thing it shows.
inline View flat_view(const glm::dvec3& eye, const glm::dvec3& target, int width = 155, int height = 115) {
    View view;
    view.size.width = width;
    view.size.height = height;
    view.camera.eye = eye;
    view.camera.target = target;
    view.light.ambient = 1.0F;
    view.shadow.kind = renderer::ShadowQuality::Kind::none;
    view.detail.pixel_error = 1e-6;
    return view;
}

inline glm::ivec4 at(const optics::Image& image, int x, int y) {
    const std::size_t i = 4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
    return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]};
}

/// Number of pixels that differ by more than `threshold` in any channel, or in colour alone.
inline int others(const optics::Image& a, const optics::Image& b, int threshold, bool alpha = true) {
    EXPECT_EQ(a.rgba.size(), b.rgba.size());
    int count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        int most = 0;
        for (std::size_t k = 0; k < (alpha ? 4U : 3U); ++k)
            most = std::max(most, std::abs(int(a.rgba[i + k]) - int(b.rgba[i + k])));
        count += most > threshold ? 1 : 0;
    }
    return count;
}

inline double voxel_side(const scenes::Scene& scene, int resolution) {
    return voxelizer::grid_around(scenes::take_snapshot(scene).bounds, resolution).voxel_size;
}

}  // namespace cairn::test
