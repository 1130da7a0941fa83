#pragma once

#include <string>
#include <vector>

#include "optics/light.h"
#include "renderer/shadow_renderer.h"
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
    /// Rays meet all of it; of a soft shadow map, the casters throw shadows on the ground.
    [[nodiscard]] renderer::ShadowScene shadow_scene(renderer::ShadowMethod method) const;
    [[nodiscard]] const optics::Light& light() const { return light_; }
    /// All that throws shadows and the half of the shadow that is next to it, with that light. @param rays to
    /// it, a pixel
    [[nodiscard]] renderer::View view(int width, int height, int rays) const;

private:
    std::string name_;
    scenes::Scene scene_;
    scenes::NodeSelection ground_nodes_, caster_nodes_;
    scenes::Snapshot all_, casters_;
    scenes::Bounds framed_;  ///< what pictures show
    optics::Light light_;
};

}  // namespace cairn::bench
