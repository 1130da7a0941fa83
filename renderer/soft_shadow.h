#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gl/shader_source.h"
#include "renderer/renderer.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/soft_shadow_map.h"
#include "scenes/node_selection.h"
#include "scenes/scene.h"
#include "scenes/snapshot.h"

namespace cairn::renderer {

/// A picture, and what its shadow was made of, pixel by pixel.
struct SoftShadowPicture {
    optics::Image image;
    std::vector<float> visible;   ///< share of the light that a receiver sees; -1: not on a receiver
    std::vector<float> distance;  ///< from the eye; infinite = nothing there
};

/// Pictures of a rasterized scene with the soft shadow of some nodes on others (shadow/soft_shadow_map.h).
/// Needs the context that was current at its construction.
class SoftShadowRenderer {
public:
    /// The scene must outlive it, and the snapshot too: windows are fitted to its vertices for each light.
    /// What is neither occluder nor receiver is not drawn. Nothing can be both: it would shadow itself.
    /// @throws Error  Fault::usage when a node is both, or a size is out of range; Fault::memory when it does
    ///                not fit.
    SoftShadowRenderer(const scenes::Scene& scene, const scenes::Snapshot& snapshot,
                       const scenes::NodeSelection& occluders, const scenes::NodeSelection& receivers,
                       const SoftShadowOptions& options = {}, const gl::ShaderSource& shaders = {});
    SoftShadowRenderer(SoftShadowRenderer&&) noexcept;
    SoftShadowRenderer& operator=(SoftShadowRenderer&&) noexcept;
    SoftShadowRenderer(const SoftShadowRenderer&) = delete;
    SoftShadowRenderer& operator=(const SoftShadowRenderer&) = delete;
    ~SoftShadowRenderer();

    /// @param view     its light is a rectangle. Its voxels and its shadow rays do not count.
    /// @param frustum  none: fit_shadow_frustum.
    /// @throws Error  Fault::usage for a size, a light or a frustum that is none.
    [[nodiscard]] SoftShadowPicture render(const View& view,
                                           const std::optional<ShadowFrustum>& frustum = std::nullopt);

    [[nodiscard]] const SoftShadowMap& map() const;  ///< of the last render()

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace cairn::renderer
