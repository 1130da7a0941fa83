#pragma once

#include <string>
#include <vector>

#include "optics/light.h"
#include "renderer/shadow_renderer.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::bench {

/// A scene on a square of ground, so that methods without self-shadowing can be compared too, under a
/// rectangular light.
class ShadowScene {
public:
    /// @param with_ground  false: the scene alone, under the same light.
    explicit ShadowScene(const std::string& path, bool with_ground = true);
    ShadowScene(const ShadowScene&) = delete;
    ShadowScene& operator=(const ShadowScene&) = delete;
    ShadowScene(ShadowScene&&) = delete;
    ShadowScene& operator=(ShadowScene&&) = delete;
    ~ShadowScene() = default;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const scenes::Scene& scene() const { return scene_; }
    [[nodiscard]] const scenes::Snapshot& all() const { return all_; }
    /// Everything but the ground.
    [[nodiscard]] const scenes::Snapshot& casters() const { return casters_; }
    [[nodiscard]] const scenes::NodeSelection& caster_nodes() const { return caster_nodes_; }
    [[nodiscard]] const scenes::NodeSelection& ground_nodes() const { return ground_nodes_; }
    /// For rays, everything both casts and receives shadows. For soft shadow maps, the casters cast shadows
    /// on the ground.
    [[nodiscard]] renderer::ShadowScene shadow_scene(renderer::ShadowMethod method) const;
    [[nodiscard]] const optics::Light& light() const { return light_; }
    /// A view of the casters and of the half of the shadow that is next to them, with light().
    /// @param rays  rays per pixel to the light
    [[nodiscard]] renderer::View view(int width, int height, int rays) const;

private:
    std::string name_;
    scenes::Scene scene_;
    scenes::NodeSelection ground_nodes_, caster_nodes_;
    scenes::Snapshot all_, casters_;
    scenes::Bounds framed_;  ///< part of the scene that pictures show
    optics::Light light_;
};

}  // namespace cairn::bench
