#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "renderer/mesh/mesh_raster.h"
#include "renderer/mesh/mix.h"
#include "renderer/renderer.h"
#include "scenes/snapshot.h"
#include "tests/support/mesh_rays.h"
#include "tests/support/test_scenes.h"
#include "tests/support/voxel_renderer.h"

namespace cairn::test {

/// A square of voxels at height 1 over a floor that is a mesh, under a rectangular light: the share of
/// the light that each pixel sees has a closed form.
class SquareOverFloorScene {
public:
    static constexpr double square_half = 0.5;
    static constexpr double light_height = 3.0;
    static constexpr double light_half = 0.4;

    explicit SquareOverFloorScene(int size, const Settings& options = {.tree = {.max_resolution = 4096}})
        : size_(size),
          renderer_(voxel_renderer(square_, scenes::take_snapshot(square_), options)),
          rays_(view(1)) {
        renderer_.set_mix(
            {.meshes = std::make_shared<renderer::MeshRaster>(floor_, scenes::take_snapshot(floor_)),
             .mesh_shadows = true,
             .voxels_hidden = true});
    }

    /// @param moved  offset of the light's middle from the place above the square's middle
    [[nodiscard]] renderer::View view(int rays, bool cones = false, const glm::dvec2& moved = {}) const {
        renderer::View view;
        view.size.width = size_;
        view.size.height = size_;
        view.camera = {
            .eye = {0.0, 6.0, 0.0}, .target = {0.0, 0.0, 0.0}, .up = {0.0, 0.0, -1.0}, .yfov = 0.5};
        view.detail.pixel_error = 1e-6;
        view.light.positional = true;
        view.light.position = {moved.x, light_height, moved.y};
        view.light.shape = optics::LightShape::rectangle;
        view.light.half_u = {light_half, 0.0, 0.0};
        view.light.half_v = {0.0, 0.0, light_half};
        view.shadow = {
            .kind = cones ? renderer::ShadowQuality::Kind::cones : renderer::ShadowQuality::Kind::rays,
            .samples = rays};
        return view;
    }

    /// The square's projection on the light's plane is a square too.
    [[nodiscard]] double truth(int x, int y, const glm::dvec2& moved = {}) const {
        const glm::dvec3 direction = rays_.direction({x + 0.5, y + 0.5});
        const glm::dvec3 point = rays_.eye - direction * (rays_.eye.y / direction.y);
        const auto hidden = [](double at, double middle) {
            const double low = at + (-square_half - at) * light_height - middle;
            const double high = at + (square_half - at) * light_height - middle;
            return std::max(0.0, std::min(high, light_half) - std::max(low, -light_half)) /
                   (2.0 * light_half);
        };
        return 1.0 - hidden(point.x, moved.x) * hidden(point.z, moved.y);
    }

    [[nodiscard]] int size() const { return size_; }
    renderer::Renderer& renderer() { return renderer_; }

private:
    int size_;
    /// Adds crumbs far beside the picture, so that the root's voxels are as wide as the widest cones.
    static std::vector<glm::vec3> square_and_crumbs() {
        std::vector<glm::vec3> corners =
            quad({-0.5F, 1, -0.5F}, {-0.5F, 1, 0.5F}, {0.5F, 1, 0.5F}, {0.5F, 1, -0.5F});
        for (const float at : {-4.0F, 4.0F}) {
            for (const glm::vec3& corner : quad({at, 1.31F, at}, {at, 1.31F, at + 0.1F},
                                                {at + 0.1F, 1.31F, at + 0.1F}, {at + 0.1F, 1.31F, at}))
                corners.push_back(corner);
        }
        return corners;
    }

    scenes::Scene square_ = colored(square_and_crumbs(), glm::vec4(1.0F));
    scenes::Scene floor_ = colored(quad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5}), glm::vec4(1.0F));
    renderer::Renderer renderer_;
    PictureRays rays_;
};

}  // namespace cairn::test
