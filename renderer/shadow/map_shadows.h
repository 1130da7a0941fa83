#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gl/shader_source.h"
#include "renderer/shadow/shadow_base.h"
#include "renderer/shadow/shadow_frustum.h"
#include "renderer/shadow/soft_shadow_map.h"

namespace cairn::renderer {

/// Pictures of a rasterized scene with the soft shadow of some nodes on others. SoftShadowMap has the limits
/// of the method.
///
/// Lights are rectangles. The level of detail of a view is ignored. Shadows must be of
/// ShadowQuality::Kind::rays, whose number of samples is ignored too: the shadow is that of the whole light.
/// ShadowTimes::shadow_ms is that of the map on the driver's clock, without drawing the picture.
class MapShadows final : public ShadowRenderer {
public:
    /// Nodes that are neither casters nor receivers are not drawn. The scene and the snapshot must outlive
    /// the renderer, because windows are fitted to their vertices for each light.
    /// @throws Error  Fault::usage if a node is both caster and receiver, because it would shadow itself, or
    ///                if a size is out of range; Fault::memory if the scene does not fit.
    explicit MapShadows(const ShadowScene& scene, const SoftShadowOptions& options = {},
                        const gl::ShaderSource& shaders = {});
    MapShadows(const MapShadows&) = delete;
    MapShadows& operator=(const MapShadows&) = delete;
    MapShadows(MapShadows&&) = delete;
    MapShadows& operator=(MapShadows&&) = delete;
    ~MapShadows() override;

    /// @throws Error  as ShadowRenderer does; Fault::usage if the light is not a rectangle, if the view has
    ///                an anchor or other shadows than rays, or if the frustum is invalid.
    [[nodiscard]] ShadowPicture render(const View& view, const ShadowRequest& request = {}) override;
    void move_to(double seconds) override;

    /// Sets what the map covers in the pictures from now on; none: fit_shadow_frustum().
    void set_frustum(const std::optional<ShadowFrustum>& frustum);

    /// The map of the last picture.
    [[nodiscard]] const SoftShadowMap& map() const;
    /// Distances from the eye, one per pixel of the last picture; infinite if the pixel shows nothing.
    [[nodiscard]] const std::vector<float>& distances() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cairn::renderer
