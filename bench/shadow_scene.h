#pragma once

#include <memory>
#include <string>
#include <vector>

#include "reference/area_light.h"
#include "reference/shadow_truth.h"
#include "renderer/camera.h"
#include "renderer/light.h"
#include "renderer/renderer.h"
#include "scenes/node_selection.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

/// A scene on a square of ground, so that methods without self-shadowing can be compared too, and a
/// rectangular light above.
class ShadowScene {
public:
    /// @param with_ground  false: the scene as it is, under the same light.
    explicit ShadowScene(const std::string& path, bool with_ground = true);
    ShadowScene(const ShadowScene&) = delete;
    ShadowScene& operator=(const ShadowScene&) = delete;
    ShadowScene(ShadowScene&&) = delete;
    ShadowScene& operator=(ShadowScene&&) = delete;
    ~ShadowScene() = default;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
    [[nodiscard]] const scenes::Snapshot& all() const { return all_; }
    [[nodiscard]] const scenes::Snapshot& casters() const { return casters_; }  ///< all but the ground
    [[nodiscard]] const scenes::NodeSelection& caster_nodes() const { return caster_nodes_; }
    [[nodiscard]] const scenes::NodeSelection& ground_nodes() const { return ground_nodes_; }
    [[nodiscard]] const renderer::Light& light() const { return light_; }
    /// The whole of it, with that light. @param rays  to it, a pixel
    [[nodiscard]] renderer::View view(int width, int height, int rays) const;

private:
    std::string name_;
    scenes::Scene scene_;
    scenes::NodeSelection ground_nodes_, caster_nodes_;
    scenes::Snapshot all_, casters_;
    renderer::Light light_;
};

/// Frames of which only the shadow comes from voxels: the scene is rasterized, and rays go from its pixels to
/// the light (Forest et al. 2009, section 3.1), as `cairn shadow` has it.
[[nodiscard]] std::shared_ptr<renderer::Renderer> shadowing_renderer(const ShadowScene& scene,
                                                                     const renderer::TreeOptions& tree,
                                                                     const gl::ShaderSource& shaders);

/// A tree of exactly so many voxels a side: 8, or 16 and more, a power of two.
[[nodiscard]] renderer::TreeOptions tree_of(int resolution);
/// Rays go by the finest voxels of their tree, whatever a pixel shows.
constexpr double always_finest = 1e-3;  // pixel error

}  // namespace cairn::bench
